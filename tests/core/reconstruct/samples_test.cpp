#include "core/reconstruct/samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/mesh/subdivide_uniform.h"
#include "core/parallel.h"
#include "core/photometry.h"
#include "tests/core/reconstruct/gathering.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

using test::floor_only;
using test::Gathering;
using test::solid_box;

Scene under_sky(Scene scene) {
  scene.sky.luminance = Rgb(1.0F);
  return scene;
}

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

/// A cut floor under the sky; the finer side reaches from one corner to the diagonal.
struct CutFloor {
  CutFloor(std::int8_t coarse, std::int8_t fine) : gathering(under_sky(floor_only())) {
    const std::int8_t levels[] = {coarse, fine};
    mesh = subdivide_uniform(gathering.prepared.scene, {.level_of_triangle = levels}, {}).mesh;
  }
  Samples samples(const SampleOptions& options) const { return gather_samples(mesh, gathering.gatherer, options, {}); }

  Gathering gathering;
  RefinedMesh mesh;
};

/// How many samples lie in each triangle of the scene.
std::vector<std::uint32_t> count_by_triangle(const RefinedMesh& mesh, const Samples& samples) {
  std::vector<std::uint32_t> counts;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    counts.resize(std::max<std::size_t>(counts.size(), mesh.triangle_of_element[e] + 1), 0U);
    counts[mesh.triangle_of_element[e]] += samples.first_of_element[e + 1] - samples.first_of_element[e];
  }
  return counts;
}

TEST(Samples, AreSeveralInEveryElementOfACoarseMesh) {
  const CutFloor floor(1, 4);  // areas 1 : 64, and some in between along the diagonal
  const Samples samples = floor.samples({.per_element = 3});
  for (std::size_t e = 0; e < floor.mesh.elements.size(); ++e) {
    EXPECT_GE(samples.first_of_element[e + 1] - samples.first_of_element[e], 3U) << e;
  }
}

TEST(Samples, AreMoreInALargeElement) {
  const CutFloor floor(1, 4);
  const Samples samples = floor.samples({.per_element = 3, .at_least = 1});
  const auto count = floor.mesh.elements.size();
  for (std::uint32_t e = 0; e < count; ++e) {
    // An ordinary element has the mean area, 16 m2 / count.
    const double wanted = 3.0 * double{element_area(floor.mesh, e)} * static_cast<double>(count) / 16.0;
    const double expected = std::clamp(wanted, 1.0, 64.0);
    EXPECT_NEAR(samples.first_of_element[e + 1] - samples.first_of_element[e], expected, 1.0) << e;
  }
}

TEST(Samples, AreManyInAMeshOfFewElements) {
  const CutFloor floor(1, 4);
  const Samples samples = floor.samples({.per_element = 3, .at_least = 600});
  EXPECT_GE(samples.sample_count(), 600U);
  const std::vector<std::uint32_t> counts = count_by_triangle(floor.mesh, samples);
  EXPECT_GE(counts[0], 64U * 2U);  // two or more large elements, as many as there may be in one
}

TEST(Samples, AreSpreadByAreaInAFineMesh) {
  const CutFloor floor(2, 6);  // 16 elements in one half, 4096 and those along the diagonal in the other
  ASSERT_GT(floor.mesh.elements.size(), 4000U);
  const SampleOptions options{.per_element = 3, .at_least = 1, .max_ordinary = 500};
  const Samples samples = floor.samples(options);
  EXPECT_LE(samples.sample_count(), options.max_ordinary * 3 + 1);
  const std::vector<std::uint32_t> counts = count_by_triangle(floor.mesh, samples);
  EXPECT_NEAR(counts[1], 750.0, 1.0);
  EXPECT_NEAR(counts[0], 750.0, 16.0);  // 47 in each of 16 elements
}

TEST(Samples, CoverAnElementEvenly) {
  // Moments of a triangle by its corner weights: 1/3, and 1/6 for squares; kept a little away from the edges.
  const CutFloor floor(3, 3);
  const Samples samples = floor.samples({.per_element = 16});
  glm::dvec3 mean(0.0), square(0.0);
  for (const glm::vec3& weights : samples.weights) {
    EXPECT_NEAR(weights.x + weights.y + weights.z, 1.0F, 1e-6F);
    for (int k = 0; k < 3; ++k) EXPECT_GT(weights[k], 0.01F);
    mean += glm::dvec3(weights);
    square += glm::dvec3(weights * weights);
  }
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(mean[k] / static_cast<double>(samples.sample_count()), 1.0 / 3.0, 0.005);
    EXPECT_NEAR(square[k] / static_cast<double>(samples.sample_count()), 1.0 / 6.0, 0.01);
  }
}

TEST(Samples, FindTheMeanOfAnElementHalfInShadow) {
  Scene scene = floor_only();
  scene.lights = {{.kind = Light::Kind::kDirectional, .direction = {0, -1, 0}}};
  for (const glm::vec3 p : {glm::vec3(-3, 1, -3), {0, 1, -3}, {0, 1, 3}, {-3, 1, 3}}) {
    scene.positions.push_back(p);
    scene.normals.emplace_back(0, 1, 0);
  }
  scene.triangles.emplace_back(4, 6, 5);
  scene.triangles.emplace_back(4, 7, 6);
  scene.surface_of_triangle.insert(scene.surface_of_triangle.end(), 2, 1U);
  const ElementLight light = mean_of_samples(Gathering(scene).samples({.per_element = 32}));
  EXPECT_NEAR(0.5F * (light.irradiance[0].x + light.irradiance[1].x), 0.5F, 0.1F);
}

TEST(Samples, AreNeverBelowWhatStandsOnAFloor) {
  const Gathering g(test::sunk_box(0.5F));
  const RefinedMesh mesh = subdivide_uniform(g.prepared.scene, {.patch_size = 0.3F, .level_of_triangle = {}}, {}).mesh;
  const Samples samples = gather_samples(mesh, g.gatherer, {}, {});
  int on_floor = 0;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    for (std::uint32_t s = samples.first_of_element[e]; s < samples.first_of_element[e + 1]; ++s) {
      if (mesh.triangle_of_element[e] >= 2) continue;
      const glm::uvec3& element = mesh.elements[e];
      glm::vec3 position(0.0F);
      for (int k = 0; k < 3; ++k) position += samples.weights[s][k] * mesh.positions[element[k]];
      EXPECT_FALSE(position.x > -0.37F && position.x < 0.63F && position.z > -0.71F && position.z < 0.29F);
      EXPECT_GE(samples.irradiance[s].y, 9.999F);  // the sun
      ++on_floor;
    }
  }
  EXPECT_GT(on_floor, 300);
  EXPECT_GT(std::count(samples.buried.begin(), samples.buried.end(), 1), 10);
}

// Sheets whose fronts face the inside of a wall were black posts between the windows of a bathroom.
TEST(Samples, ShowTheBackOfASheetWhoseFrontNoLightReachesIfAsked) {
  // Of the wall between both rooms only the sheet that faces the dark one is left.
  Scene scene = test::rooms_on_one_floor(0.9F, 0.1F);
  const std::size_t count = scene.triangles.size();
  const bool first_is_left = scene.positions[scene.triangles[count - 4].x].x < 0.95F;
  const auto left = scene.triangles.end() - (first_is_left ? 4 : 2);
  scene.triangles.erase(left, left + 2);
  scene.surface_of_triangle.resize(scene.triangles.size());
  for (Surface& surface : scene.surfaces) surface.two_sided = true;
  Gathering g(scene);
  const auto brightest = [&] {
    const ElementLight light = g.elements();
    float most = 0.0F;
    for (std::size_t e = count - 4; e < count - 2; ++e) most = std::max(most, luminance_of(light.irradiance[e]));
    return most;
  };
  EXPECT_EQ(brightest(), 0.0F);
  g.gatherer.shows_reached_side = true;
  EXPECT_GT(brightest(), 1.0F) << "1 cd half a metre behind it";
}

TEST(Samples, AreTheSameForAnyNumberOfThreads) {
  const Gathering g(test::cornell_box(), Rgb(0.3F, 0.2F, 0.1F));
  const RefinedMesh mesh = subdivide_uniform(g.prepared.scene, {.patch_size = 0.1F, .level_of_triangle = {}}, {}).mesh;
  const Samples all = gather_samples(mesh, g.gatherer, {}, {});
  for (const int threads : {1, 3}) {
    const Samples some = on_threads(threads, [&] { return gather_samples(mesh, g.gatherer, {}, {}); });
    EXPECT_EQ(some.first_of_element, all.first_of_element);
    EXPECT_EQ(some.weights, all.weights);
    EXPECT_EQ(some.irradiance, all.irradiance);
    EXPECT_EQ(some.buried, all.buried);
  }
}

TEST(Samples, AreNoneInAnEmptyMesh) {
  const Gathering g(floor_only());
  const Samples samples = gather_samples({}, g.gatherer, {}, {});
  EXPECT_EQ(samples.sample_count(), 0U);
  EXPECT_EQ(samples.first_of_element, (std::vector<std::uint32_t>{0}));
  EXPECT_TRUE(mean_of_samples(samples).irradiance.empty());
}

TEST(Samples, HaveAMeanByElement) {
  const Samples samples{.first_of_element = {0, 2, 2, 3},
                        .weights = std::vector<glm::vec3>(3, glm::vec3(1.0F / 3.0F)),
                        .irradiance = {{1, 2, 3}, {3, 2, 1}, {5, 5, 5}},
                        .buried = {0, 1, 0}};
  const ElementLight light = mean_of_samples(samples);
  EXPECT_EQ(light.irradiance, (std::vector<Rgb>{{2, 2, 2}, {0, 0, 0}, {5, 5, 5}}));
  EXPECT_EQ(light.unknown, (std::vector<std::uint8_t>{0, 1, 0}));
}

TEST(Samples, StopWhenCancelled) {
  const Gathering g(test::cornell_box());
  const Progress cancelled{.report = {}, .cancelled = [] { return true; }};
  EXPECT_THROW(gather_samples(unrefined(g.prepared.scene), g.gatherer, {}, cancelled), Cancelled);
}

}  // namespace
}  // namespace radiosity
