#include "core/bake.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <tuple>

#include "core/mesh/t_vertices.h"
#include "core/photometry.h"
#include "tests/core/same_bytes.h"
#include "tests/core/test_scenes.h"
#include "tests/core/test_skies.h"

namespace radiosity {
namespace {

using test::same_bytes;

/// Small and quick: some hundred patches, hemicubes of 16 cells.
BakeOptions quick(float patch_size) {
  BakeOptions options;
  options.subdivide.patch_size = patch_size;
  options.max_patches = 300;
  options.hemicube_resolution = 16;
  options.visibility = Visibility::kRays;
  return options;
}

/// The area each vertex stands for, m2.
std::vector<double> vertex_areas(const RefinedMesh& mesh) {
  std::vector<double> areas(mesh.positions.size(), 0.0);
  for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) {
    for (int k = 0; k < 3; ++k) areas[mesh.elements[e][k]] += double{element_area(mesh, e)} / 3.0;
  }
  return areas;
}

/// How far two bakes of one mesh are apart: area-weighted root mean square and largest difference of the irradiance,
/// relative to its mean.
struct Difference {
  double rms = 0.0, largest = 0.0;
};

Difference difference(const Bake& a, const Bake& b) {
  const std::vector<double> areas = vertex_areas(a.mesh);
  double square = 0.0, mean = 0.0, area = 0.0, largest = 0.0;
  for (std::size_t v = 0; v < areas.size(); ++v) {
    const double apart = double{luminance_of(a.irradiance[v] - b.irradiance[v])};
    square += areas[v] * apart * apart;
    mean += areas[v] * double{luminance_of(b.irradiance[v])};
    area += areas[v];
    largest = std::max(largest, std::abs(apart));
  }
  return {std::sqrt(square / area) / (mean / area), largest / (mean / area)};
}

/// The largest relative error of the displayed luminance in a closed room that emits 1 cd/m2 everywhere.
double furnace_error(float rho, const BakeOptions& options) {
  const Bake baked = bake(test::white_furnace(rho, 1.0F), options, {});
  double largest = 0.0;
  for (const Rgb& irradiance : baked.irradiance) {
    const double luminance = 1.0 + double{reflected_luminance(Rgb(rho), irradiance).y};
    largest = std::max(largest, std::abs(luminance * (1.0 - double{rho}) - 1.0));
  }
  return largest;
}

TEST(Bake, ShowsEOver1MinusRhoAtEveryVertexOfAWhiteFurnace) {
  for (const Solver solver : {Solver::kProgressive, Solver::kGathering}) {
    for (const float rho : {0.5F, 0.9F}) {
      BakeOptions options = quick(0.15F);
      options.solver = solver;
      EXPECT_LT(furnace_error(rho, options), 0.005);
    }
  }
}

TEST(Bake, ShowsThatByDefaultToo) {
  for (const float rho : {0.5F, 0.9F}) {
    BakeOptions options;
    options.subdivide.patch_size = 0.2F;
    EXPECT_LT(furnace_error(rho, options), 0.005) << rho;
  }
}

TEST(Bake, MakesAsManyPatchesAsTheMeshIsWorth) {
  EXPECT_EQ(automatic_patches(30, 16), 1000);
  EXPECT_EQ(automatic_patches(9000, 16), 3000);
  EXPECT_EQ(automatic_patches(5'000'000, 16), 30'000);
  EXPECT_EQ(automatic_patches(9000, 8), 1500);
  EXPECT_EQ(automatic_patches(0, 2), 125);
  BakeOptions options;
  options.refine = Refine::kNone;
  const BakeReport automatic = bake(test::cornell_box(), options, {}).report;
  EXPECT_LE(automatic.patch_count, 1000U);
  EXPECT_GT(automatic.patch_count, 500U);
}

TEST(Bake, KeepsTheMeanLightOfAClosedRoom) {
  // All that is brought in over what is not reflected: the flux of a candela in all directions over 1 - rho.
  Scene scene = test::box_room({1, 2, 3}, {.reflectance = Rgb(0.6F)});
  scene.lights = {{.kind = Light::Kind::kPoint, .position = {0.4F, 1.3F, 1.1F}}};
  for (const Fit fit : {Fit::kLeastSquares, Fit::kInterpolate}) {
    BakeOptions options = quick(0.3F);
    options.max_patches = 4000;
    options.fit = fit;
    const Bake baked = bake(scene, options, {});
    const std::vector<double> areas = vertex_areas(baked.mesh);
    double received = 0.0;
    for (std::size_t v = 0; v < areas.size(); ++v) received += areas[v] * double{baked.irradiance[v].y};
    EXPECT_NEAR(received * 0.4 / (4.0 * double{kPi}), 1.0, 0.01);
  }
}

TEST(Bake, IsNearlyTheSameForBothFits) {
  BakeOptions options = quick(0.05F);
  const Bake least_squares = bake(test::cornell_box(), options, {});
  options.fit = Fit::kInterpolate;
  EXPECT_LT(difference(least_squares, bake(test::cornell_box(), options, {})).rms, 0.06);
}

TEST(Bake, DirectAndIndirectLightAddUpToBoth) {
  Scene scene = test::cornell_box();
  scene.lights = {{.kind = Light::Kind::kPoint, .position = {2.0F, 2.0F, 2.0F}}};
  scene.sky.luminance = Rgb(0.2F);
  std::vector<Bake> parts;
  for (const LightParts part : {LightParts::kBoth, LightParts::kDirect, LightParts::kIndirect}) {
    BakeOptions options = quick(2.0F);
    options.fit = Fit::kInterpolate;  // linear in the samples; least squares cut off what is negative
    options.parts = part;
    parts.push_back(bake(scene, options, {}));
  }
  double direct = 0.0, indirect = 0.0;
  for (std::size_t v = 0; v < parts[0].irradiance.size(); ++v) {
    const Rgb sum = parts[1].irradiance[v] + parts[2].irradiance[v];
    EXPECT_LT(glm::length(sum - parts[0].irradiance[v]), 1e-4F * (1.0F + glm::length(sum))) << v;
    direct += double{luminance_of(parts[1].irradiance[v])};
    indirect += double{luminance_of(parts[2].irradiance[v])};
  }
  EXPECT_GT(direct, 0.0);
  EXPECT_GT(indirect, 0.1 * direct);
}

TEST(Bake, HasNoIndirectLightWhereNothingReflects) {
  Scene scene = test::box_room({1, 2, 3}, {.reflectance = Rgb(0.0F), .emission = Rgb(1.0F)});
  scene.lights = {{.kind = Light::Kind::kPoint, .position = {0.4F, 1.3F, 1.1F}}};
  BakeOptions options = quick(1.0F);
  options.parts = LightParts::kIndirect;
  for (const Rgb& irradiance : bake(scene, options, {}).irradiance) EXPECT_LT(luminance_of(irradiance), 1e-5F);
}

TEST(Bake, IsTheSameForBothSolvers) {
  for (const auto& [scene, patch_size] : {std::pair(test::cornell_box(), 0.05F), {test::occluder(), 0.25F}}) {
    BakeOptions options = quick(patch_size);
    options.max_patches = 1000;
    options.solver = Solver::kProgressive;
    const Bake shot = bake(scene, options, {});
    options.solver = Solver::kGathering;
    const Difference found = difference(shot, bake(scene, options, {}));
    EXPECT_LT(found.rms, 0.005);
    EXPECT_LT(found.largest, 0.005);
  }
}

TEST(Bake, IsTheSameForBothMakersOfItemBuffers) {
  BakeOptions options = quick(0.05F);
  const Bake rays = bake(test::cornell_box(), options, {});
  options.visibility = Visibility::kRaster;
  const Bake raster = bake(test::cornell_box(), options, {});
  EXPECT_EQ(rays.report.visibility, Visibility::kRays);
  EXPECT_EQ(raster.report.visibility, Visibility::kRaster);
  EXPECT_LT(difference(rays, raster).rms, 0.01);
}

TEST(Bake, GivesTheSameBytesForAnyNumberOfThreads) {
  for (const Solver solver : {Solver::kProgressive, Solver::kGathering}) {
    BakeOptions options = quick(0.06F);
    options.max_patches = 150;
    options.solver = solver;
    options.row_cache_bytes = 40'000;  // evictions included
    Scene scene = test::cornell_box();
    scene.sky.luminance = {0.1F, 0.2F, 0.3F};
    options.threads = 1;
    const Bake one = bake(scene, options, {});
    for (const int threads : {2, 7}) {
      options.threads = threads;
      const Bake many = bake(scene, options, {});
      EXPECT_TRUE(same_bytes(one.irradiance, many.irradiance)) << threads;
      EXPECT_EQ(one.report.steps, many.report.steps);
      EXPECT_EQ(one.report.escaped_flux, many.report.escaped_flux);
    }
  }
}

TEST(Bake, GivesTheSameBytesWhereRowsOfFormFactorsAreEvicted) {
  BakeOptions options = quick(0.2F);
  options.row_cache_bytes = 100'000;
  for (const Solver solver : {Solver::kGathering, Solver::kProgressive}) {
    options.solver = solver;
    BakeOptions unlimited = options;
    unlimited.row_cache_bytes = BakeOptions{}.row_cache_bytes;
    EXPECT_TRUE(same_bytes(bake(test::cornell_box(), unlimited, {}).irradiance,
                           bake(test::cornell_box(), options, {}).irradiance));
  }
}

TEST(Bake, GivesTheSameBytesByDefaultForAnyNumberOfThreads) {
  const Scene scene = test::wall_through_floor(0.5F);
  BakeOptions options;
  options.subdivide.patch_size = 0.3F;
  options.max_patches = 1500;
  options.threads = 1;
  const Bake one = bake(scene, options, {});
  for (const int threads : {2, 7}) {
    options.threads = threads;
    EXPECT_TRUE(same_bytes(one.irradiance, bake(scene, options, {}).irradiance)) << threads;
  }
}

/// Blue above, brown below, and a sun behind the open front of the Cornell box.
Sky sky_with_a_sun() {
  Sky sky = test::sky_of(
      128, [](const glm::vec3& d) { return d.y > 0.0F ? Rgb(0.1F, 0.2F, 0.3F) : Rgb(0.06F, 0.05F, 0.04F); });
  test::add_sun(sky, glm::normalize(glm::vec3(0.1F, 0.4F, -1.0F)), {5, 5, 4});
  return sky;
}

TEST(Bake, GivesTheSameBytesUnderASkyWithAMapForAnyNumberOfThreads) {
  BakeOptions options = quick(0.06F);
  options.max_patches = 150;
  Scene scene = test::cornell_box();
  scene.sky = sky_with_a_sun();
  options.threads = 1;
  const Bake one = bake(scene, options, {});
  for (const int threads : {2, 7}) {
    options.threads = threads;
    EXPECT_TRUE(same_bytes(one.irradiance, bake(scene, options, {}).irradiance)) << threads;
  }
}

TEST(Bake, IsTheSameUnderAConstantMapAsUnderAConstantSky) {
  Scene scene = test::cornell_box();
  scene.sky.luminance = {0.1F, 0.2F, 0.3F};
  const Bake constant = bake(scene, quick(0.08F), {});
  scene.sky = test::sky_of(64, [](const glm::vec3&) { return Rgb(0.1F, 0.2F, 0.3F); });
  EXPECT_LT(difference(constant, bake(scene, quick(0.08F), {})).rms, 1e-3);
}

/// The same triangles in another order.
Scene permuted(const Scene& scene) {
  std::vector<std::uint32_t> order(scene.triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  Scene result = scene;
  for (std::size_t t = 0; t < order.size(); ++t) {
    result.triangles[t] = scene.triangles[order[t]];
    result.surface_of_triangle[t] = scene.surface_of_triangle[order[t]];
  }
  return result;
}

TEST(Bake, IsNearlyTheSameForPermutedTriangles) {
  // Other samples, the same light. Single vertices differ by more than this mean where a shadow ends in an element.
  const Scene scene = test::tessellated(test::cornell_box(), 4);
  BakeOptions options = quick(0.0F);
  options.refine = Refine::kNone;
  options.max_patches = 8000;
  const Bake a = bake(scene, options, {}), b = bake(permuted(scene), options, {});
  EXPECT_LT(difference(a, b).rms, 0.025);  // 0.015
  EXPECT_EQ(a.report.patch_count, b.report.patch_count);
}

TEST(Bake, IsNearlyTheSameAtEveryVertexForPermutedTrianglesWhereNoShadowEnds) {
  Scene scene = test::tessellated(test::box_room({1, 2, 3}, {.reflectance = Rgb(0.6F)}), 8);
  scene.lights = {{.kind = Light::Kind::kPoint, .position = {0.5F, 1.0F, 1.5F}}};
  BakeOptions options = quick(0.0F);
  options.refine = Refine::kNone;
  options.max_patches = 4000;
  EXPECT_LT(difference(bake(scene, options, {}), bake(permuted(scene), options, {})).largest, 0.05);  // 0.034
}

TEST(Bake, IsLinearInTheLight) {
  Scene scene = test::cornell_box();
  const Bake dim = bake(scene, quick(0.08F), {});
  for (Surface& surface : scene.surfaces) surface.emission *= 64.0F;  // a power of two: no rounding
  const Bake bright = bake(scene, quick(0.08F), {});
  for (std::size_t v = 0; v < dim.irradiance.size(); ++v) {
    EXPECT_NEAR(bright.irradiance[v].y, 64.0F * dim.irradiance[v].y, 1e-4F * bright.irradiance[v].y);
  }
}

TEST(Bake, BalancesFlux) {
  Scene under_sky = test::occluder();
  under_sky.sky.luminance = Rgb(1.0F);
  Scene under_map = test::occluder();
  under_map.sky = sky_with_a_sun();
  Scene punctual = test::cornell_box();
  punctual.surfaces[3].emission = Rgb(0.0F);
  punctual.lights = {{.kind = Light::Kind::kPoint, .position = {0.28F, 0.4F, 0.28F}}};
  const std::map<std::string, Scene> scenes = {{"furnace", test::white_furnace(0.8F, 1.0F)},
                                               {"cornell", test::cornell_box()},
                                               {"occluder", test::occluder()},
                                               {"occluder under a sky", under_sky},
                                               {"occluder under a map", under_map},
                                               {"cornell by a point", punctual}};
  for (const auto& [name, scene] : scenes) {
    BakeOptions options = quick(0.5F);
    options.max_patches = 1000;  // with 300 what two hemicubes a patch do not measure comes to a hundredth
    options.solver = Solver::kProgressive;
    const BakeReport shot = bake(scene, options, {}).report;
    EXPECT_GT(shot.emitted_flux, 0.0);
    EXPECT_NEAR((shot.absorbed_flux + shot.escaped_flux) / shot.emitted_flux, 1.0, 0.005) << name;
    options.solver = Solver::kGathering;
    const BakeReport gathered = bake(scene, options, {}).report;
    EXPECT_NEAR((gathered.absorbed_flux + gathered.escaped_flux) / gathered.emitted_flux, 1.0, 0.01) << name;
  }
}

TEST(Bake, LeavesADarkSceneDark) {
  const Bake dark = bake(test::box_room({1, 1, 1}, {}), quick(0.5F), {});
  EXPECT_FALSE(dark.report.lit);
  EXPECT_EQ(dark.report.emitted_flux, 0.0);
  EXPECT_EQ(dark.irradiance.size(), dark.mesh.positions.size());
  for (const Rgb& irradiance : dark.irradiance) EXPECT_EQ(irradiance, Rgb(0.0F));
}

TEST(Bake, AcceptsASceneWithoutAnything) {
  const Bake nothing = bake({}, quick(0.5F), {});
  EXPECT_FALSE(nothing.report.lit);
  EXPECT_TRUE(nothing.irradiance.empty());
}

TEST(Bake, AcceptsASceneWithoutArea) {
  Scene scene = test::cornell_box();
  for (glm::vec3& position : scene.positions) position = glm::vec3(1.0F);
  const Bake flat = bake(scene, quick(0.5F), {});
  EXPECT_EQ(flat.report.degenerate_triangle_count, scene.triangles.size());
  EXPECT_FALSE(flat.report.lit);
}

TEST(Bake, LightsBlackSurfacesToo) {
  Scene scene = test::cornell_box();
  for (Surface& surface : scene.surfaces) surface.reflectance = Rgb(0.0F);
  const Bake direct_only = bake(scene, quick(0.1F), {});
  EXPECT_TRUE(direct_only.report.lit);
  EXPECT_GT(std::count_if(direct_only.irradiance.begin(), direct_only.irradiance.end(),
                          [](const Rgb& irradiance) { return irradiance.y > 0.1F; }),
            20);
}

/// Two rooms of 1 m side by side, both with white walls, the left one with a lamp; `gap` metres apart.
Scene two_rooms(float gap) {
  Scene scene = test::box_room(glm::vec3(1.0F), {.reflectance = Rgb(0.7F)});
  const Scene room = scene;
  for (std::size_t v = 0; v < room.positions.size(); ++v) {
    scene.positions.push_back(room.positions[v] + glm::vec3(1.0F + gap, 0, 0));
    scene.normals.push_back(room.normals[v]);
  }
  for (const glm::uvec3& triangle : room.triangles) {
    scene.triangles.push_back(triangle + static_cast<std::uint32_t>(room.positions.size()));
    scene.surface_of_triangle.push_back(0);
  }
  scene.lights = {{.kind = Light::Kind::kPoint, .position = {0.5F, 0.5F, 0.5F}}};
  return scene;
}

/// Mean irradiance of the vertices right of the wall over that of those left of it.
double leak(const Scene& scene, const BakeOptions& options, float wall) {
  const Bake baked = bake(scene, options, {});
  const std::vector<double> areas = vertex_areas(baked.mesh);
  double lit = 0.0, lit_area = 0.0, dark = 0.0, dark_area = 0.0;
  for (std::size_t v = 0; v < areas.size(); ++v) {
    const bool right = baked.mesh.positions[v].x > wall;
    (right ? dark : lit) += areas[v] * double{luminance_of(baked.irradiance[v])};
    (right ? dark_area : lit_area) += areas[v];
  }
  return (dark / dark_area) / (lit / lit_area);
}

// What is left with the progressive solver is the ambient estimate.
TEST(Bake, LeaksNoLightThroughAClosedWall) {
  for (const float gap : {0.2F, 0.5F}) {
    EXPECT_LT(leak(two_rooms(gap), quick(0.2F), 1.0F + 0.5F * gap), 0.001) << gap;
  }
}

/// Light in the dark room beyond one element from the wall, over the mean of the lit room: the largest and the mean.
struct Leak {
  double largest = 0.0, mean = 0.0;
};

Leak leak_on_one_floor(float wall, float thickness, const BakeOptions& options) {
  const Bake baked = bake(test::rooms_on_one_floor(wall, thickness), options, {});
  const std::vector<double> areas = vertex_areas(baked.mesh);
  double lit = 0.0, lit_area = 0.0, dark = 0.0, dark_area = 0.0, largest = 0.0;
  for (std::size_t v = 0; v < areas.size(); ++v) {
    const float x = baked.mesh.positions[v].x;
    const double light = double{luminance_of(baked.irradiance[v])};
    if (x < wall) {
      lit += areas[v] * light;
      lit_area += areas[v];
    } else if (x > wall + thickness + options.subdivide.patch_size) {
      dark += areas[v] * light;
      dark_area += areas[v];
      largest = std::max(largest, light);
    }
  }
  const double lit_mean = lit / lit_area;
  return {largest / lit_mean, dark / dark_area / lit_mean};
}

TEST(Bake, LeaksNoLightUnderAWallOnOneFloor) {
  for (const auto& [wall, thickness] : {std::pair(1.0F, 0.1F), {0.873F, 0.1F}, {1.0F, 0.002F}}) {
    for (const Solver solver : {Solver::kProgressive, Solver::kGathering}) {
      BakeOptions options = quick(0.2F);
      options.solver = solver;
      EXPECT_LT(leak_on_one_floor(wall, thickness, options).largest, 0.001) << wall << ", " << thickness;
    }
  }
}

// A tile is not cut for ever: one that stands half in the other room shows its light there, on a strip up to a
// sixteenth of a patch wide. At 300 patches that is 1.7 % at some vertices.
TEST(Bake, LeaksLittleLightUnderAWallThinnerThanTheSmallestTile) {
  BakeOptions options = quick(0.1F);
  options.max_patches = 2000;
  const Leak leak = leak_on_one_floor(0.873F, 0.002F, options);
  EXPECT_LT(leak.mean, 0.001);      // 0.0003
  EXPECT_LT(leak.largest, 0.0075);  // 0.0043
}

TEST(Bake, LeavesNoHaloAroundWhatStandsOnAFloor) {
  // Black surfaces under a sun straight above: the same light right up to the box and on both sides of the wall.
  for (const Scene& scene : {test::sunk_box(0.0F), test::wall_through_floor(0.0F)}) {
    const Bake baked = bake(scene, quick(0.2F), {});
    std::vector<std::uint8_t> on_floor(baked.mesh.positions.size(), 0);
    for (std::size_t e = 0; e < baked.mesh.elements.size(); ++e) {
      if (baked.mesh.triangle_of_element[e] >= 2) continue;
      for (int k = 0; k < 3; ++k) on_floor[baked.mesh.elements[e][k]] = 1;
    }
    EXPECT_GT(std::count(on_floor.begin(), on_floor.end(), 1), 100);
    for (std::size_t v = 0; v < on_floor.size(); ++v) {
      if (on_floor[v] == 0) continue;
      EXPECT_NEAR(baked.irradiance[v].y, 10.0F, 0.1F) << baked.mesh.positions[v].x;
    }
  }
}

TEST(Bake, LeaksNoLightIntoAWhiteBoxWhereItWouldBeReflectedAHundredTimes) {
  Scene scene = test::sunk_box(0.99F);
  scene.surfaces[1].two_sided = true;
  const Bake baked = bake(scene, quick(0.1F), {});
  int inside = 0;
  for (std::size_t v = 0; v < baked.irradiance.size(); ++v) {
    const glm::vec3 from_middle = glm::abs(baked.mesh.positions[v] - glm::vec3(0.13F, 0.0F, -0.21F));
    if (from_middle.y > 1e-4F || std::max(from_middle.x, from_middle.z) > 0.35F) continue;
    EXPECT_LT(baked.irradiance[v].y, 1e-4F) << from_middle.x << ", " << from_middle.z;
    ++inside;
  }
  EXPECT_GT(inside, 20);
}

TEST(Bake, DarkensNoFloorBesideABoxThatReflects) {
  // What the box sends back comes on top of the sun.
  const Bake baked = bake(test::sunk_box(0.5F), quick(0.2F), {});
  for (std::size_t v = 0; v < baked.irradiance.size(); ++v) {
    if (std::abs(baked.mesh.positions[v].y) < 1e-4F && baked.mesh.normals[v].y > 0.5F) {
      EXPECT_GT(baked.irradiance[v].y, 9.9F) << baked.mesh.positions[v].x << ", " << baked.mesh.positions[v].z;
    }
  }
}

TEST(Bake, ShowsTheFrontOfAPlaneThatIsLitFromBothSides) {
  Scene scene = test::floor_only();
  scene.surfaces[0].two_sided = true;
  scene.lights = {{.kind = Light::Kind::kDirectional, .direction = {0, -1, 0}, .intensity = Rgb(10.0F)},
                  {.kind = Light::Kind::kDirectional, .direction = {0, 1, 0}, .intensity = Rgb(70.0F)}};
  for (const Rgb& irradiance : bake(scene, quick(0.5F), {}).irradiance) EXPECT_NEAR(irradiance.y, 10.0F, 1e-3F);
  scene.lights.erase(scene.lights.begin());
  for (const Rgb& irradiance : bake(scene, quick(0.5F), {}).irradiance) EXPECT_NEAR(irradiance.y, 0.0F, 1e-3F);
}

TEST(Bake, LeavesBacksDark) {
  // A bright plate above the floor, lit from above, and the floor around it: its back sends nothing down.
  Scene scene = test::occluder();
  scene.surfaces[1] = {.reflectance = Rgb(0.9F)};
  scene.surfaces[2].emission = Rgb(0.0F);
  scene.lights = {{.kind = Light::Kind::kDirectional, .direction = {0, -1, 0}, .intensity = Rgb(10.0F)}};
  const auto in_the_middle_of_the_shadow = [&] {
    const Bake baked = bake(scene, quick(0.1F), {});
    double largest = 0.0;
    for (std::size_t v = 0; v < baked.irradiance.size(); ++v) {
      const glm::vec3& p = baked.mesh.positions[v];
      if (p.y == 0.0F && std::max(std::abs(p.x), std::abs(p.z)) < 0.25F)
        largest = std::max(largest, double{baked.irradiance[v].y});
    }
    return largest;
  };
  EXPECT_LT(in_the_middle_of_the_shadow(), 0.02);
  scene.surfaces[1].two_sided = true;
  EXPECT_GT(in_the_middle_of_the_shadow(), 0.3);
}

TEST(Bake, StopsInEveryPhaseWhenCancelled) {
  Scene scene = test::cornell_box();
  scene.sky.luminance = Rgb(0.1F);
  std::vector<std::string> phases;
  const Progress listen{.report =
                            [&](std::string_view phase, double done) {
                              EXPECT_GE(done, 0.0);
                              EXPECT_LE(done, 1.0);
                              if (phases.empty() || phases.back() != phase) phases.emplace_back(phase);
                            },
                        .cancelled = {}};
  BakeOptions options = quick(0.3F);
  options.refine = Refine::kAdaptive;
  bake(scene, options, listen);
  EXPECT_GE(phases.size(), 6U);

  for (const std::string& phase : phases) {
    std::string current;
    const Progress stop{.report = [&](std::string_view p, double) { current = p; },
                        .cancelled = [&] { return current == phase; }};
    EXPECT_THROW(bake(scene, options, stop), Cancelled) << phase;
  }
}

TEST(Bake, RefinementEndsWhenTimeIsUp) {
  // A clock that runs only while the mesh is refined.
  const Scene scene = test::cornell_box();
  BakeOptions options = quick(0.3F);
  options.refine = Refine::kAdaptive;
  options.adapt.max_error = 1e-4;
  double left = 3.5;
  const Progress hurried{.report = [&left](std::string_view phase, double) { left -= phase == "refine" ? 1.0 : 0.0; },
                         .cancelled = {},
                         .seconds_left = [&left] { return left; }};
  const Bake baked = bake(scene, options, hurried);
  EXPECT_EQ(baked.report.refine_end, RefineEnd::kTime);
  EXPECT_TRUE(baked.report.out_of_time);
  EXPECT_EQ(baked.report.refine_rounds, 3U);
  EXPECT_GT(baked.report.estimated_error, 0.0);
}

TEST(Bake, WithoutTimeToGatherThereIsNoLight) {
  const Progress late{.report = {}, .cancelled = {}, .seconds_left = [] { return -1.0; }};
  EXPECT_THROW(bake(test::cornell_box(), quick(0.3F), late), OutOfTime);
}

TEST(Bake, CountsWhatItMade) {
  const Scene scene = test::cornell_box();
  const Bake baked = bake(scene, quick(0.1F), {});
  EXPECT_EQ(baked.report.vertex_count, baked.mesh.positions.size());
  EXPECT_EQ(baked.report.vertex_count, baked.irradiance.size());
  EXPECT_EQ(baked.report.element_count, baked.mesh.elements.size());
  EXPECT_GT(baked.report.element_count, scene.triangles.size());
  EXPECT_LE(baked.report.patch_count, 300U);
  EXPECT_GT(baked.report.steps, 0U);
  EXPECT_LE(baked.report.residual, 0.001F);
  EXPECT_TRUE(baked.report.lit);
}

TEST(Bake, KeepsTheScenesTrianglesWhenNotRefined) {
  BakeOptions options = quick(0.1F);
  options.refine = Refine::kNone;
  const Scene scene = test::cornell_box();
  EXPECT_EQ(bake(scene, options, {}).mesh.elements, scene.triangles);
}

BakeOptions adaptive(double max_error, std::size_t max_vertices) {
  BakeOptions options = quick(0.3F);
  options.refine = Refine::kAdaptive;
  options.adapt.max_error = max_error;
  options.adapt.max_vertices = max_vertices;
  return options;
}

std::size_t t_vertices_in(const RefinedMesh& mesh) {
  return find_t_vertices(mesh.positions, mesh.elements, rounding_tolerance(mesh.positions)).size();
}

TEST(Bake, EndsWithTheCoarseMeshUnderConstantLight) {
  Scene scene = test::floor_only();
  scene.lights = {{.kind = Light::Kind::kDirectional, .direction = {0, -1, 0}, .intensity = Rgb(3.0F)}};
  BakeOptions options = adaptive(0.001, 1000);
  options.subdivide.patch_size = 10.0F;
  const Bake baked = bake(scene, options, {});
  EXPECT_EQ(baked.mesh.elements, scene.triangles);
  EXPECT_EQ(baked.report.refine_end, RefineEnd::kError);
  EXPECT_LT(baked.report.estimated_error, 1e-4);
}

TEST(Bake, RefinesOnlyAlongTheEdgeOfAShadow) {
  // The sun casts the shadow of a square on the floor: |x| or |z| is 0.5 along its edge.
  Scene scene = test::occluder();
  scene.surfaces[2].emission = Rgb(0.0F);
  scene.lights = {{.kind = Light::Kind::kDirectional, .direction = {0, -1, 0}, .intensity = Rgb(10.0F)}};
  const auto edge_distance = [](const glm::vec3& p) { return std::abs(std::max(std::abs(p.x), std::abs(p.z)) - 0.5F); };
  BakeOptions options = adaptive(1e-6, 1500);
  options.subdivide.patch_size = 0.5F;
  const Bake baked = bake(scene, options, {});
  EXPECT_EQ(baked.report.refine_end, RefineEnd::kLimit);
  std::size_t small = 0, far = 0;
  for (std::uint32_t e = 0; e < baked.mesh.elements.size(); ++e) {
    if (element_area(baked.mesh, e) > 0.01F) continue;
    const glm::uvec3& corner = baked.mesh.elements[e];
    const float distance =
        std::min({edge_distance(baked.mesh.positions[corner.x]), edge_distance(baked.mesh.positions[corner.y]),
                  edge_distance(baked.mesh.positions[corner.z])});
    ++small;
    far += distance > 0.3F ? 1U : 0U;
  }
  EXPECT_GT(small, 1000U);
  EXPECT_LT(far, small / 50);
}

TEST(Bake, SpendsAFewVerticesWhereTheyAreNeededThoughTheSceneIsFine) {
  // A shadow on a floor of 20 000 triangles, of which few lie on its edge: a 64th of them at once is all there may be.
  Scene scene = test::tessellated(test::occluder(), 70);
  for (Surface& surface : scene.surfaces) surface.emission = Rgb(0.0F);
  scene.lights = {{.kind = Light::Kind::kDirectional, .direction = {0, -1, 0}, .intensity = Rgb(10.0F)}};
  BakeOptions options = adaptive(1e-6, scene.positions.size() + 300);
  options.subdivide.patch_size = 0.0F;
  const Bake baked = bake(scene, options, {});
  EXPECT_EQ(baked.report.refine_end, RefineEnd::kLimit);
  EXPECT_GE(baked.report.refine_rounds, 4U);
}

TEST(Bake, EndsRefinementWhereItIsTold) {
  const Scene scene = test::cornell_box();
  const Bake by_error = bake(scene, adaptive(0.04, 100'000), {});
  EXPECT_EQ(by_error.report.refine_end, RefineEnd::kError);
  EXPECT_LE(by_error.report.estimated_error, 0.04);
  EXPECT_GT(by_error.report.refine_rounds, 2U);

  const Bake by_vertices = bake(scene, adaptive(1e-6, 500), {});
  EXPECT_EQ(by_vertices.report.refine_end, RefineEnd::kLimit);
  EXPECT_LE(by_vertices.mesh.positions.size(), 500U);
  EXPECT_GT(by_vertices.mesh.positions.size(), 495U);

  BakeOptions coarse = adaptive(1e-6, 100'000);
  coarse.adapt.min_edge = 0.12F;
  EXPECT_EQ(bake(scene, coarse, {}).report.refine_end, RefineEnd::kFloor);
}

TEST(Bake, RefinesWithoutCracksAndKeepsOldVertices) {
  for (const Scene& scene : {test::cornell_box(), test::sunk_box(0.5F), test::many_boxes(5, 3)}) {
    const std::size_t before = t_vertices_in(unrefined(scene));
    const Bake baked = bake(scene, adaptive(0.01, scene.positions.size() + 500), {});
    EXPECT_LE(t_vertices_in(baked.mesh), before);
    ASSERT_GT(baked.mesh.positions.size(), scene.positions.size());
    EXPECT_TRUE(std::equal(scene.positions.begin(), scene.positions.end(), baked.mesh.positions.begin()));
    EXPECT_TRUE(std::ranges::is_sorted(baked.mesh.triangle_of_element));
  }
}

TEST(Bake, RefinesToTheSameBytesForAnyNumberOfThreads) {
  const Scene scene = test::cornell_box();
  BakeOptions options = adaptive(0.01, 800);
  options.threads = 1;
  const Bake one = bake(scene, options, {});
  for (const int threads : {2, 7}) {
    options.threads = threads;
    const Bake more = bake(scene, options, {});
    EXPECT_EQ(more.mesh.elements, one.mesh.elements);
    EXPECT_TRUE(same_bytes(more.irradiance, one.irradiance));
    EXPECT_EQ(more.report.estimated_error, one.report.estimated_error);
  }
}

}  // namespace
}  // namespace radiosity
