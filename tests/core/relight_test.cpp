#include "core/relight.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <random>

#include "tests/core/four_lights.h"

namespace radiosity {
namespace {

using test::four_lights;
using test::rms_difference;
using test::same_bytes;
using enum test::Group;

BakeOptions keeping() {
  BakeOptions options = test::quick_groups();
  options.keep_transport = true;
  options.residual = 1e-5F;
  return options;
}

/// The largest difference in any band at any vertex, relative to the mean of `b`.
double largest_difference(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
  double largest = 0.0, sum = 0.0;
  for (std::size_t v = 0; v < a.size(); ++v) {
    const glm::vec3 apart = glm::abs(a[v] - b[v]);
    largest = std::max(largest, static_cast<double>(std::max({apart.x, apart.y, apart.z})));
    sum += static_cast<double>((b[v].x + b[v].y + b[v].z) / 3.0F);
  }
  return largest / (sum / static_cast<double>(b.size()));
}

Scene dimmed(Scene scene, const std::vector<Rgb>& dimmers) {
  for (Surface& surface : scene.surfaces) surface.emission *= dimmers[surface.light_group];
  for (Light& light : scene.lights) light.intensity *= dimmers[light.light_group];
  scene.sky.luminance *= dimmers[scene.sky.light_group];
  return scene;
}

std::vector<Rgb> random_dimmers(std::mt19937& generator) {
  std::uniform_real_distribution<float> amount(0.05F, 2.0F);
  std::vector<Rgb> dimmers(kGroupCount);
  for (Rgb& dimmer : dimmers) dimmer = {amount(generator), amount(generator), amount(generator)};
  return dimmers;
}

TEST(Relight, GivesTheBakeAgainIfNothingChanges) {
  const Bake baked = bake(four_lights(), keeping(), {});
  const std::vector<Rgb> again = relight(baked.transport->view(), std::vector<Rgb>(kGroupCount, Rgb(1.0F)));
  EXPECT_LT(largest_difference(again, baked.irradiance), 1e-4);
}

TEST(Relight, GivesWhatABakeUnderOtherLightsGives) {
  const Scene scene = four_lights();
  const Bake baked = bake(scene, keeping(), {});
  std::mt19937 generator(1);
  for (int k = 0; k < 3; ++k) {
    const std::vector<Rgb> dimmers = random_dimmers(generator);
    const Bake full = bake(dimmed(scene, dimmers), keeping(), {});
    const std::vector<Rgb> relit = relight(baked.transport->view(), dimmers);
    EXPECT_LT(rms_difference(relit, full.irradiance), 1e-4);
    EXPECT_LT(largest_difference(relit, full.irradiance), 1e-3);
  }
}

TEST(Relight, GivesWhatABakeOfTheRefinedMeshGives) {
  // What was cut adaptively, as a scene of its own: its samples and patches are what they were.
  BakeOptions options = keeping();
  options.refine = Refine::kAdaptive;
  options.adapt = {.max_error = 0.05, .max_vertices = 1500};
  const Bake cut = bake(four_lights(), options, {});
  Scene scene = four_lights();
  const std::vector<std::uint32_t> surface_of = scene.surface_of_triangle;
  scene.positions = cut.mesh.positions;
  scene.normals = cut.mesh.normals;
  scene.triangles = cut.mesh.elements;
  scene.surface_of_triangle.clear();
  for (const std::uint32_t triangle : cut.mesh.triangle_of_element) {
    scene.surface_of_triangle.push_back(surface_of[triangle]);
  }
  options.refine = Refine::kNone;
  const Bake baked = bake(scene, options, {});
  std::mt19937 generator(2);
  const std::vector<Rgb> dimmers = random_dimmers(generator);
  const Bake full = bake(dimmed(scene, dimmers), options, {});
  EXPECT_LT(rms_difference(relight(baked.transport->view(), dimmers), full.irradiance), 1e-4);
  EXPECT_LT(largest_difference(relight(baked.transport->view(), dimmers), full.irradiance), 1e-3);
}

TEST(Relight, GivesWhatABakeBetweenOtherSurfacesGives) {
  Scene scene = four_lights();
  const Bake baked = bake(scene, keeping(), {});
  const LightTransport transport = baked.transport->view();
  ASSERT_TRUE(transport.has_rows());
  scene.surfaces[0].reflectance = {0.2F, 0.5F, 0.9F};
  scene.surfaces[1].reflectance = {0.0F, 0.7F, 0.1F};
  std::vector<Rgb> reflectance(transport.reflectance.begin(), transport.reflectance.end());
  for (std::size_t i = 0; i < reflectance.size(); ++i) {
    const std::uint32_t surface = transport.surface[i];
    if (surface <= 1) reflectance[i] = transport.undyed[i] * scene.surfaces[surface].reflectance;
  }
  std::mt19937 generator(3);
  const std::vector<Rgb> dimmers = random_dimmers(generator);
  const Bake full = bake(dimmed(scene, dimmers), keeping(), {});
  const std::vector<Rgb> relit = relight(transport, dimmers, reflectance, {});
  EXPECT_LT(rms_difference(relit, full.irradiance), 1e-4);
  EXPECT_LT(largest_difference(relit, full.irradiance), 1e-3);
}

TEST(Relight, KnowsDirectAndIndirectLightApart) {
  const Scene scene = four_lights();
  std::mt19937 generator(4);
  const std::vector<Rgb> dimmers = random_dimmers(generator);
  for (const LightParts parts : {LightParts::kDirect, LightParts::kIndirect}) {
    BakeOptions options = keeping();
    options.parts = parts;
    const Bake baked = bake(scene, options, {});
    const Bake full = bake(dimmed(scene, dimmers), options, {});
    const LightTransport transport = baked.transport->view();
    EXPECT_LT(rms_difference(relight(transport, dimmers), full.irradiance), 1e-4) << static_cast<int>(parts);
    const std::vector<Rgb> solved = relight(transport, dimmers, transport.reflectance, {});
    EXPECT_LT(rms_difference(solved, full.irradiance), 1e-4) << static_cast<int>(parts);
  }
}

TEST(Relight, LightsWhatWasDimmedToNothing) {
  Scene scene = four_lights();
  scene.dimmers.assign(kGroupCount, Rgb(1.0F));
  scene.dimmers[kBulb] = scene.dimmers[kSky] = Rgb(0.0F);
  const Bake dark = bake(scene, keeping(), {});
  const Bake lit = bake(four_lights(), keeping(), {});
  const std::vector<Rgb> relit = relight(dark.transport->view(), std::vector<Rgb>(kGroupCount, Rgb(1.0F)));
  EXPECT_LT(rms_difference(relit, lit.irradiance), 1e-4);
}

TEST(Relight, NeitherDriftsNorGrowsOverAThousandChanges) {
  const Bake baked = bake(four_lights(), keeping(), {});
  const LightTransport transport = baked.transport->view();
  std::mt19937 generator(5);
  const std::vector<Rgb> dimmers = random_dimmers(generator);
  const std::vector<Rgb> first = relight(transport, dimmers);
  const std::size_t bytes_in_use = ::mallinfo2().uordblks;
  for (int k = 0; k < 1000; ++k) relight(transport, random_dimmers(generator));
  EXPECT_LT(::mallinfo2().uordblks, bytes_in_use + 65536);
  EXPECT_TRUE(same_bytes(relight(transport, dimmers), first));
}

TEST(Relight, GoesWithoutRowsWhereMemoryIsShort) {
  BakeOptions options = keeping();
  options.row_cache_bytes = 100'000;
  const Bake baked = bake(four_lights(), options, {});
  const LightTransport transport = baked.transport->view();
  EXPECT_FALSE(transport.has_rows());
  EXPECT_TRUE(transport.cell_patch.empty());
  EXPECT_TRUE(transport.row_factor.empty());
  const std::vector<Rgb> again = relight(transport, std::vector<Rgb>(kGroupCount, Rgb(1.0F)));
  EXPECT_LT(largest_difference(again, baked.irradiance), 1e-4);
}

TEST(Relight, GoesWithoutRowsWhereSamplesSeeTooMuch) {
  BakeOptions options = keeping();
  options.row_cache_bytes = 3'000'000;  // enough for the patches
  const Bake baked = bake(four_lights(), options, {});
  EXPECT_FALSE(baked.transport->view().has_rows());
}

}  // namespace
}  // namespace radiosity
