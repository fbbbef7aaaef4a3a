#include "core/verify/path_tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/photometry.h"
#include "core/reconstruct/gather.h"
#include "core/transport/form_factors.h"
#include "core/transport/solve_gathering.h"
#include "tests/core/prepared_scene.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

/// Mean over paths, and how far off it may be: 5 standard deviations.
struct Estimate {
  double luminance = 0.0;
  double tolerance = 0.0;
  double back_share = 0.0;
};

Estimate estimate(const PathTracer& tracer, const SurfacePoint& point, int paths) {
  Random random(7, 3);
  double sum = 0.0, square_sum = 0.0, backs = 0.0;
  for (int i = 0; i < paths; ++i) {
    const PathSample sample = tracer.sample(point.position, point.normal, random);
    const auto luminance = static_cast<double>(luminance_of(sample.irradiance));
    sum += luminance;
    square_sum += luminance * luminance;
    backs += sample.sees_back ? 1.0 : 0.0;
  }
  const double mean = sum / paths;
  const double variance = std::max(0.0, square_sum / paths - mean * mean) / (paths - 1);
  return {mean, 5.0 * std::sqrt(variance) + 1e-4 * mean, backs / paths};
}

Estimate estimate(const Scene& scene, const SurfacePoint& point, int paths) {
  const RayScene rays(scene);
  return estimate(PathTracer(rays), point, paths);
}

Scene black_floor() {
  Scene scene;
  scene.positions = {{-5, 0, -5}, {-5, 0, 5}, {5, 0, 5}, {5, 0, -5}};
  scene.normals.assign(4, {0, 1, 0});
  scene.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.surface_of_triangle = {0, 0};
  scene.surfaces = {Surface{Rgb(0.0F)}};
  return scene;
}

constexpr SurfacePoint kFloorPoint{{1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}};

TEST(PathTracer, AWhiteFurnaceIsExitanceOverAbsorption) {
  for (const float rho : {0.3F, 0.8F}) {
    const Estimate light = estimate(test::white_furnace(rho, 2.0F), {{0.3F, 0.0F, 0.6F}, {0, 1, 0}}, 3000);
    EXPECT_NEAR(light.luminance, 2.0 * double{kPi} / (1.0 - double{rho}), light.tolerance);
    EXPECT_EQ(light.back_share, 0.0);
  }
}

TEST(PathTracer, AnOpenSkyBringsPiTimesItsLuminance) {
  Scene scene = black_floor();
  scene.sky.luminance = Rgb(3.0F);
  const Estimate light = estimate(scene, kFloorPoint, 100);
  EXPECT_NEAR(light.luminance, 3.0 * double{kPi}, 1e-3);
}

TEST(PathTracer, PunctualLightsAsTheExtensionDefinesThem) {
  Light point{Light::Kind::kPoint, {1.0F, 2.0F, 0.0F}};
  point.intensity = Rgb(8.0F);
  Light ranged = point;
  ranged.range = 4.0F;
  Light tilted{Light::Kind::kDirectional, {}, glm::vec3(0.6F, -0.8F, 0.0F)};
  tilted.intensity = Rgb(5.0F);
  Light spot{Light::Kind::kSpot, {1.0F, 2.0F, 0.0F}, {0.0F, -1.0F, 0.0F}};
  spot.intensity = Rgb(4.0F);
  spot.inner_cone_cos = 0.9F;
  spot.outer_cone_cos = 0.7F;

  Scene scene = black_floor();
  scene.lights = {point};
  EXPECT_NEAR(estimate(scene, kFloorPoint, 4).luminance, 2.0, 1e-3);
  scene.lights = {ranged};
  EXPECT_NEAR(estimate(scene, kFloorPoint, 4).luminance, 2.0 * 15.0 / 16.0, 1e-3);
  scene.lights = {tilted};
  EXPECT_NEAR(estimate(scene, kFloorPoint, 4).luminance, 4.0, 1e-3);
  scene.lights = {spot};
  EXPECT_NEAR(estimate(scene, kFloorPoint, 4).luminance, 1.0, 1e-3);
  const Estimate all = [&] {
    scene.lights = {point, ranged, tilted, spot, point, ranged};
    return estimate(scene, kFloorPoint, 4000);
  }();
  EXPECT_NEAR(all.luminance, 4.0 + 3.75 + 4.0 + 1.0, 5e-3);
}

TEST(PathTracer, ALampOfTwoSquaresHasItsFormFactor) {
  // A point below the corner of a unit square at height 1: F = 1 / (pi sqrt 2) atan(1 / sqrt 2).
  const Estimate light = estimate(test::parallel_squares(1.0F), {{0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, -1.0F}}, 4000);
  const double form_factor = std::atan(std::sqrt(0.5)) * std::sqrt(0.5) / double{kPi};
  // Square 1 reflects half of what it gets, but square 0 reflects nothing.
  EXPECT_NEAR(light.luminance, double{kPi} * form_factor, light.tolerance);
}

TEST(PathTracer, ATwoSidedLampShinesBothWays) {
  Scene scene = test::parallel_squares(1.0F);
  const SurfacePoint behind{{0.5F, 0.5F, -1.0F}, {0.0F, 0.0F, 1.0F}};
  EXPECT_EQ(estimate(scene, behind, 200).luminance, 0.0);
  EXPECT_GT(estimate(scene, behind, 200).back_share, 0.1);
  scene.surfaces[0].two_sided = true;
  const Estimate lit = estimate(scene, behind, 4000);
  EXPECT_NEAR(lit.luminance, double{kPi} * 0.239456, lit.tolerance);
  EXPECT_EQ(lit.back_share, 0.0);
}

TEST(PathTracer, AFenceLetsHalfOfTheLightThrough) {
  const test::DetailedScene fence = test::see_through_fence();
  Scene open = fence.scene;
  open.surfaces[1].see_through = false;
  const SurfacePoint below{{0.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}};
  EXPECT_EQ(estimate(open, below, 500).luminance, 0.0);

  Scene lamp_only = open;
  lamp_only.triangles.erase(lamp_only.triangles.begin() + 2, lamp_only.triangles.begin() + 4);
  lamp_only.surface_of_triangle.erase(lamp_only.surface_of_triangle.begin() + 2,
                                      lamp_only.surface_of_triangle.begin() + 4);
  const Estimate through = estimate(fence.scene, below, 4000);
  const Estimate whole = estimate(lamp_only, below, 4000);
  EXPECT_NEAR(through.luminance, 0.5 * whole.luminance, 0.03 * whole.luminance + through.tolerance);
}

TEST(PathTracer, AgreesWithTheGathererInTheCornellBox) {
  // The baker's light at a few points, by quite another method.
  const test::PreparedScene prepared(test::cornell_box(), 600, 16);
  RowCache rows(*prepared.rows, std::size_t{1} << 30U);
  const std::vector<Rgb> direct = direct_on_patches(prepared.direct, prepared.patches, {});
  const Solution solution = solve_gathering({prepared.patches, direct, 1e-3F}, rows, {});
  const Gatherer gatherer{prepared.scene,  prepared.patches, prepared.hemicube,  *prepared.items,
                          prepared.direct, prepared.sky,     solution.radiosity, surface_offset(prepared.scene)};
  const PathTracer tracer(prepared.rays);
  const SurfacePoint points[] = {
      {{0.1F, 0.0F, 0.1F}, {0, 1, 0}}, {{0.45F, 0.0F, 0.25F}, {0, 1, 0}}, {{0.25F, 0.4F, 0.559F}, {0, 0, -1}}};
  std::uint32_t index = 0;
  for (const SurfacePoint& point : points) {
    const double gathered = static_cast<double>(luminance_of(gatherer.at(point, ++index).irradiance));
    const Estimate traced = estimate(tracer, point, 4000);
    EXPECT_NEAR(traced.luminance, gathered, 0.04 * gathered + traced.tolerance);
  }
}

}  // namespace
}  // namespace radiosity
