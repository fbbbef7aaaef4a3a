#include "core/light_groups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/bake.h"
#include "tests/core/four_lights.h"
#include "tests/core/test_skies.h"

namespace radiosity {
namespace {

using test::four_lights;
using test::quick_groups;
using test::rms_difference;
using test::same_bytes;

using enum test::Group;

/// The largest difference between the whole and the sum of its parts in any band at any vertex, relative to that.
double largest_gap(const Scene& scene, const Bake& bake) {
  double largest = 0.0;
  for (std::size_t v = 0; v < bake.irradiance.size(); ++v) {
    glm::dvec3 sum(0.0);
    for (std::uint32_t g = 0; g < bake.group_irradiance.size(); ++g) {
      sum += glm::dvec3(dimmer_of(scene, g) * bake.group_irradiance[g][v]);
    }
    for (int band = 0; band < 3; ++band) {
      const auto whole = static_cast<double>(bake.irradiance[v][band]);
      if (sum[band] != whole) largest = std::max(largest, std::abs(sum[band] - whole) / std::max(whole, 1e-12));
    }
  }
  return largest;
}

/// All of a scene's light but that of one group as good as turned off. What no light at all reaches takes no part in
/// the exchange: then there would be other patches.
Scene alone(Scene scene, std::uint32_t group) {
  constexpr float kHardlyAny = 1e-6F;
  for (Surface& surface : scene.surfaces) {
    if (surface.light_group != group) surface.emission *= kHardlyAny;
  }
  for (Light& light : scene.lights) {
    if (light.light_group != group) light.intensity *= kHardlyAny;
  }
  if (scene.sky.light_group != group) scene.sky.luminance *= kHardlyAny;
  return scene;
}

TEST(LightGroups, AddUpToTheWholeAtEveryVertexOfEveryMesh) {
  const Scene scene = four_lights();
  for (const Refine refine : {Refine::kNone, Refine::kUniform, Refine::kAdaptive}) {
    for (const Fit fit : {Fit::kLeastSquares, Fit::kInterpolate}) {
      BakeOptions options = quick_groups();
      options.refine = refine;
      options.fit = fit;
      options.adapt = {.max_error = 0.1, .max_vertices = 800};
      const Bake baked = bake(scene, options, {});
      ASSERT_EQ(baked.group_irradiance.size(), kGroupCount);
      EXPECT_LT(largest_gap(scene, baked), 1e-5) << static_cast<int>(refine) << static_cast<int>(fit);
    }
  }
}

TEST(LightGroups, AddUpToTheDirectAndToTheIndirectLight) {
  const Scene scene = four_lights();
  for (const LightParts parts : {LightParts::kDirect, LightParts::kIndirect}) {
    BakeOptions options = quick_groups();
    options.parts = parts;
    EXPECT_LT(largest_gap(scene, bake(scene, options, {})), 1e-5) << static_cast<int>(parts);
  }
}

TEST(LightGroups, ChangeNothingAboutTheWhole) {
  Scene scene = four_lights();
  scene.sky = test::sky_of(64, [](const glm::vec3& d) { return d.y > 0.0F ? Rgb(0.1F, 0.2F, 0.3F) : Rgb(0.05F); });
  test::add_sun(scene.sky, glm::normalize(glm::vec3(0.1F, 0.4F, -1.0F)), {5, 5, 4});
  scene.sky.light_group = kSky;
  BakeOptions options = quick_groups();
  options.refine = Refine::kAdaptive;
  options.adapt = {.max_error = 0.05, .max_vertices = 800};
  const Bake with = bake(scene, options, {});
  EXPECT_LT(largest_gap(scene, with), 1e-5);
  options.light_groups = false;
  const Bake without = bake(scene, options, {});
  EXPECT_TRUE(same_bytes(with.irradiance, without.irradiance));
  EXPECT_TRUE(without.group_irradiance.empty());
}

TEST(LightGroups, AreWhatTheirLightsAloneBring) {
  const Scene scene = four_lights();
  const Bake together = bake(scene, quick_groups(), {});
  for (std::uint32_t group = 0; group < kGroupCount; ++group) {
    BakeOptions options = quick_groups();
    options.light_groups = false;
    const Bake single = bake(alone(scene, group), options, {});
    // But for where fits were cut off at zero, and what was still unshot.
    EXPECT_LT(rms_difference(together.group_irradiance[group], single.irradiance), 0.002) << group;
  }
}

TEST(LightGroups, DoNotDependOnHowBrightTheOthersAre) {
  Scene scene = four_lights();
  BakeOptions options = quick_groups();
  options.residual = 1e-6F;
  const Bake before = bake(scene, options, {});
  scene.surfaces[3].emission *= Rgb(0.01F, 0.2F, 3.0F);
  scene.lights[0].intensity *= Rgb(20.0F, 1.0F, 0.1F);
  const Bake after = bake(scene, options, {});
  EXPECT_LT(rms_difference(after.group_irradiance[kSky], before.group_irradiance[kSky]), 1e-3);
  EXPECT_LT(rms_difference(after.group_irradiance[kGlowingBlock], before.group_irradiance[kGlowingBlock]), 1e-3);
  std::vector<Rgb> scaled = before.group_irradiance[kLamp];
  for (Rgb& light : scaled) light *= Rgb(0.01F, 0.2F, 3.0F);
  EXPECT_LT(rms_difference(after.group_irradiance[kLamp], scaled), 1e-3);
}

TEST(LightGroups, OfLightsThatAreDimmedToNothingHaveALightOfTheirOwn) {
  Scene scene = four_lights();
  const Bake lit = bake(scene, quick_groups(), {});
  scene.dimmers.assign(kGroupCount, Rgb(1.0F));
  scene.dimmers[kBulb] = Rgb(0.0F);
  scene.dimmers[kLamp] = {1.0F, 0.0F, 2.0F};
  const Bake dimmed = bake(scene, quick_groups(), {});
  EXPECT_LT(largest_gap(scene, dimmed), 1e-5);
  EXPECT_LT(rms_difference(dimmed.group_irradiance[kBulb], lit.group_irradiance[kBulb]), 0.002);
  EXPECT_LT(rms_difference(dimmed.group_irradiance[kLamp], lit.group_irradiance[kLamp]), 0.002);
}

TEST(LightGroups, AreTheSameBytesForAnyNumberOfThreads) {
  BakeOptions options = quick_groups();
  options.threads = 1;
  const Bake one = bake(four_lights(), options, {});
  options.threads = 3;
  const Bake three = bake(four_lights(), options, {});
  for (std::uint32_t group = 0; group < kGroupCount; ++group) {
    EXPECT_TRUE(same_bytes(one.group_irradiance[group], three.group_irradiance[group])) << group;
  }
}

TEST(LightGroups, AreOneUnlessToldApart) {
  const Bake baked = bake(test::occluder(), quick_groups(), {});
  ASSERT_EQ(baked.group_irradiance.size(), 1U);
  EXPECT_TRUE(same_bytes(baked.group_irradiance[0], baked.irradiance));
}

TEST(LightGroups, WithoutADimmerEachAreRefused) {
  Scene scene = four_lights();
  scene.dimmers.assign(kGroupCount - 1, Rgb(1.0F));
  EXPECT_NE(validate(scene), std::nullopt);
  scene.dimmers.assign(kGroupCount, Rgb(-1.0F));
  EXPECT_NE(validate(scene), std::nullopt);
}

}  // namespace
}  // namespace radiosity
