#include "core/reconstruct/gather.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/photometry.h"
#include "tests/core/prepared_scene.h"
#include "tests/core/reconstruct/gathering.h"
#include "tests/core/test_scenes.h"
#include "tests/core/test_skies.h"

namespace radiosity {
namespace {

using test::floor_only;
using test::Gathering;
using test::PreparedScene;
using test::solid_box;

void expect_near(const Rgb& actual, const Rgb& expected, float relative) {
  for (int band = 0; band < 3; ++band) EXPECT_NEAR(actual[band], expected[band], relative * expected[band]) << band;
}

TEST(Gather, FindsPiTimesTheSkyOnAnOpenPlane) {
  Scene scene = floor_only();
  scene.sky.luminance = {1, 2, 3};
  const Gathering g(scene);
  const Gathered gathered = g.gatherer.at({{0.3F, 0, 0.2F}, {0, 1, 0}}, 0);
  expect_near(gathered.irradiance, kPi * scene.sky.luminance, 1e-5F);
  EXPECT_EQ(gathered.back_share, 0.0F);
  for (const Rgb& irradiance : g.elements().irradiance) expect_near(irradiance, kPi * scene.sky.luminance, 1e-5F);
}

TEST(Gather, FindsTheClosedFormOfASkyThatDimsTowardsTheHorizon) {
  // L = y: the integral of y^2 over the upper half is 2 pi / 3.
  Scene scene = floor_only();
  scene.sky = test::sky_of(128, [](const glm::vec3& d) { return std::max(0.0F, d.y); });
  const Gathering g(scene);
  for (std::uint32_t k = 0; k < 32; ++k) {
    EXPECT_NEAR(g.gatherer.at({{0.3F, 0, 0.2F}, {0, 1, 0}}, k).irradiance.y, 2.0F * kPi / 3.0F, 0.02F);
  }
}

TEST(Gather, FindsTheSameUnderAConstantMapAsUnderAConstantSky) {
  Scene scene = test::occluder();
  scene.sky.luminance = {1, 2, 3};
  const Gathering constant(scene);
  scene.sky = test::sky_of(16, [](const glm::vec3&) { return Rgb(1, 2, 3); });
  const Gathering map(scene);
  for (const float x : {0.0F, 0.7F, 1.5F}) {
    const SurfacePoint point{{x, 0, 0.2F}, {0, 1, 0}};
    expect_near(map.gatherer.at(point, 5).irradiance, constant.gatherer.at(point, 5).irradiance, 1e-4F);
  }
}

TEST(Gather, FindsASunInTheSkyWhereverItStands) {
  // 90 lx from a texel much smaller than a cell, beside pi lx from the rest.
  for (const float x : {-0.8F, -0.31F, 0.02F, 0.5F}) {
    Scene scene = floor_only();
    scene.sky = test::sky_of(1024, [](const glm::vec3&) { return 1.0F; });
    const glm::vec3 towards = glm::normalize(glm::vec3(x, 1, 0.2F));
    test::add_sun(scene.sky, towards, Rgb(90.0F));
    const Gathering g(scene);
    const float irradiance = g.gatherer.at({{0.3F, 0, 0.2F}, {0, 1, 0}}, 0).irradiance.y;
    EXPECT_NEAR(irradiance, kPi + 90.0F * towards.y, 0.3F) << x;
  }
}

TEST(Gather, FindsHalfTheSkyOnAWall) {
  Scene scene = floor_only();
  scene.sky.luminance = Rgb(1.0F);
  const Gathering g(scene, Rgb(0.0F), 64);
  // So close above the floor that it fills the lower half of the view.
  const Gathered gathered = g.gatherer.at({{0, 0.01F, 0}, {1, 0, 0}}, 0);
  EXPECT_NEAR(gathered.irradiance.x, 0.5F * kPi, 0.02F * kPi);
}

TEST(Gather, FindsTheRadiosityOfAUniformRoom) {
  const Rgb everywhere(0.5F, 1.0F, 2.0F);
  const Gathering g(test::box_room({1, 2, 3}, {}), everywhere);
  for (const glm::vec3 position : {glm::vec3(0.5F, 0, 0.5F), {0.01F, 0, 0.01F}, {0.9F, 0, 2.9F}}) {
    expect_near(g.gatherer.at({position, {0, 1, 0}}, 3).irradiance, everywhere, 1e-5F);
  }
}

TEST(Gather, AddsDirectLight) {
  Scene scene = floor_only();
  scene.sky.luminance = Rgb(1.0F);
  scene.lights = {{.kind = Light::Kind::kDirectional, .direction = {0, -1, 0}, .intensity = {10, 0, 0}}};
  expect_near(Gathering(scene).gatherer.at({{0, 0, 0}, {0, 1, 0}}, 0).irradiance, {kPi + 10.0F, kPi, kPi}, 1e-5F);
}

TEST(Gather, SeesPatchesByTheShareOfTheViewTheyFill) {
  // Square 1 sends, square 0 looks at it: from a point straight below its middle, half the side and 1 m away.
  const PreparedScene prepared(test::parallel_squares(1.0F), 200, 64);
  std::vector<Rgb> radiosity(prepared.patches.patch_count(), Rgb(0.0F));
  for (std::uint32_t p = 0; p < radiosity.size(); ++p) {
    if (prepared.patches.points_of(p)[0].position.z > 0.5F) radiosity[p] = Rgb(1.0F);
  }
  const Gatherer gatherer{prepared.scene,  prepared.patches, prepared.hemicube, *prepared.items,
                          prepared.direct, prepared.sky,     radiosity,         surface_offset(prepared.scene)};
  EXPECT_NEAR(gatherer.at({{0.5F, 0.5F, 0}, {0, 0, 1}}, 0).irradiance.x / 0.239456F, 1.0F, 0.01F);
}

TEST(Gather, CallsAPointInsideASolidBuried) {
  const Gathering g(solid_box(), Rgb(1.0F));
  const Gathered gathered = g.gatherer.at({{0.5F, 0.5F, 0.5F}, {0, 1, 0}}, 0);
  EXPECT_NEAR(gathered.back_share, 1.0F, 1e-5F);
  EXPECT_EQ(gathered.irradiance, Rgb(0.0F));
}

TEST(Gather, CallsATwoSidedShellNotBuried) {
  Scene scene = solid_box();
  scene.surfaces[0].two_sided = true;
  const Gathered gathered = Gathering(scene, Rgb(2.0F)).gatherer.at({{0.5F, 0.5F, 0.5F}, {0, 1, 0}}, 0);
  EXPECT_EQ(gathered.back_share, 0.0F);
  expect_near(gathered.irradiance, Rgb(2.0F), 1e-5F);
}

}  // namespace
}  // namespace radiosity
