#include "core/reconstruct/samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/photometry.h"
#include "tests/core/reconstruct/gathering.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

using test::floor_only;
using test::Gathering;
using test::solid_box;

TEST(Samples, AreNoneInsideASolid) {
  Scene scene = solid_box();
  scene.sky.luminance = Rgb(1.0F);
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  for (const glm::vec3 p : {glm::vec3(0.4F, 0.5F, 0.4F), {0.4F, 0.5F, 0.6F}, {0.6F, 0.5F, 0.6F}}) {
    scene.positions.push_back(p);
    scene.normals.emplace_back(0, 1, 0);
  }
  scene.triangles.emplace_back(first, first + 1, first + 2);
  scene.surface_of_triangle.push_back(0);
  const ElementLight light = Gathering(scene).elements();
  for (std::size_t e = 0; e + 1 < light.unknown.size(); ++e) EXPECT_EQ(light.unknown[e], 0) << e;
  EXPECT_EQ(light.unknown.back(), 1);
  EXPECT_EQ(light.irradiance.back(), Rgb(0.0F));
}

TEST(Samples, AreNoneWithoutArea) {
  Scene scene = floor_only();
  scene.sky.luminance = Rgb(1.0F);
  scene.triangles.emplace_back(0, 1, 1);
  scene.surface_of_triangle.push_back(0);
  const ElementLight light = Gathering(scene).elements();
  EXPECT_EQ(light.unknown, (std::vector<std::uint8_t>{0, 0, 1}));
}

TEST(Samples, ShowTheBackOfATwoSidedSurfaceWhereItsFrontIsBuried) {
  // The square faces down, onto the back of a plate just below it; the sky is above.
  Scene scene = floor_only();
  scene.sky.luminance = Rgb(1.0F);
  for (glm::uvec3& triangle : scene.triangles) std::swap(triangle.y, triangle.z);
  for (glm::vec3& normal : scene.normals) normal = -normal;
  const Scene plate = scene;
  for (std::size_t v = 0; v < plate.positions.size(); ++v) {
    scene.positions.push_back(plate.positions[v] - glm::vec3(0, 0.01F, 0));
    scene.normals.push_back(plate.normals[v]);
  }
  for (const glm::uvec3& triangle : plate.triangles) {
    scene.triangles.push_back(triangle + 4U);
    scene.surface_of_triangle.push_back(1);
  }
  for (const bool two_sided : {false, true}) {
    scene.surfaces[0].two_sided = two_sided;
    scene.surfaces[1] = {};
    const ElementLight light = Gathering(scene).elements();
    for (std::size_t e = 0; e < 2; ++e) {
      EXPECT_EQ(light.unknown[e], two_sided ? 0 : 1);
      EXPECT_NEAR(light.irradiance[e].x, two_sided ? kPi : 0.0F, 1e-4F);
    }
  }
}

TEST(Samples, LookAlongTheShadingNormals) {
  Scene scene = floor_only();
  const glm::vec3 shading = glm::normalize(glm::vec3(0.3F, 1.0F, 0.0F));
  scene.lights = {{.kind = Light::Kind::kDirectional, .direction = -shading, .intensity = Rgb(10.0F)}};
  for (glm::vec3& normal : scene.normals) normal = shading;
  for (const Rgb& irradiance : Gathering(scene).elements().irradiance) EXPECT_NEAR(irradiance.x, 10.0F, 1e-4F);
  for (glm::vec3& normal : scene.normals) normal = glm::vec3(0.0F);
  for (const Rgb& irradiance : Gathering(scene).elements().irradiance)
    EXPECT_NEAR(irradiance.x, 10.0F * shading.y, 1e-4F);
  for (glm::vec3& normal : scene.normals) normal = -shading;  // pointing to the other side: counts as flat
  for (const Rgb& irradiance : Gathering(scene).elements().irradiance)
    EXPECT_NEAR(irradiance.x, 10.0F * shading.y, 1e-4F);
}

TEST(Samples, AreMoreInALargeElement) {
  // One element, half of it in the shadow of the sun: one sample would answer all or nothing.
  Scene scene = floor_only();
  scene.lights = {{.kind = Light::Kind::kDirectional, .direction = {0, -1, 0}}};
  for (const glm::vec3 p : {glm::vec3(-3, 1, -3), {0, 1, -3}, {0, 1, 3}, {-3, 1, 3}}) {
    scene.positions.push_back(p);
    scene.normals.emplace_back(0, 1, 0);
  }
  scene.triangles.emplace_back(4, 6, 5);
  scene.triangles.emplace_back(4, 7, 6);
  scene.surface_of_triangle.insert(scene.surface_of_triangle.end(), 2, 1U);
  const ElementLight light = Gathering(scene).elements();
  EXPECT_NEAR(0.5F * (light.irradiance[0].x + light.irradiance[1].x), 0.5F, 0.1F);
}

TEST(Samples, StopWhenCancelled) {
  const Gathering g(test::cornell_box());
  const Progress cancelled{.report = {}, .cancelled = [] { return true; }};
  EXPECT_THROW(gather_samples(unrefined(g.prepared.scene), g.gatherer, {}, cancelled), Cancelled);
}

}  // namespace
}  // namespace radiosity
