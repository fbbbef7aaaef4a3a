#include "core/transport/sky_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <string>

#include "tests/core/test_skies.h"

namespace radiosity {
namespace {

using test::add_sun;
using test::integral;
using test::sky_of;

constexpr glm::vec3 kZenith(0.0F, 1.0F, 0.0F);
const glm::vec3 kHigh = glm::normalize(glm::vec3(0.3F, 0.9F, -0.2F));

Sky gradient() {
  return sky_of(64, [](const glm::vec3& d) { return Rgb(1.0F + d.y, 1.0F, 1.0F - 0.5F * d.x); });
}

/// Skies with bright parts of every size.
std::map<std::string, Sky> bright_skies() {
  std::map<std::string, Sky> skies;
  skies["sun"] = gradient();
  add_sun(skies["sun"], kHigh, {30, 20, 10});
  skies["sun alone"] = sky_of(128, [](const glm::vec3&) { return 0.0F; });
  add_sun(skies["sun alone"], kHigh, {30, 20, 10});
  skies["window"] = sky_of(256, [](const glm::vec3& d) { return glm::dot(d, kHigh) > 0.9F ? 50.0F : 0.1F; });
  skies["noise"] =
      sky_of(256, [](const glm::vec3& d) { return std::sin(7e4F * d.x + 3e4F * d.y) > 0.97F ? 90.0F : 1.0F; });
  skies["four texels"] =
      sky_of(4, [](const glm::vec3& d) { return d.x > 0.0F && d.z > 0.0F && d.y > 0.0F ? 40.0F : 1.0F; });
  for (auto& [name, sky] : skies) sky.map_from_world = map_turned_by(77.0);
  return skies;
}

/// What the bright part brings to a surface unoccluded, eye-weighted.
double unoccluded(const BrightSky& bright, const glm::vec3& normal) {
  std::vector<double> until;
  return bright.weigh(normal, until);
}

TEST(SkyParts, AConstantMapIsAllSmooth) {
  const Sky sky = sky_of(32, [](const glm::vec3&) { return Rgb(1.0F, 2.0F, 3.0F); });
  EXPECT_TRUE(BrightSky(sky).empty());
  const SmoothSky smooth(sky, 16);
  EXPECT_FALSE(smooth.is_constant());
  integral([&](const glm::vec3& d) {
    EXPECT_NEAR(glm::length(smooth.luminance(d) - Rgb(1, 2, 3)), 0.0F, 1e-5F);
    return d;
  });
}

TEST(SkyParts, ASkyWithoutAMapHasNoBrightPart) {
  Sky sky;
  sky.luminance = {1, 2, 3};
  EXPECT_TRUE(BrightSky(sky).empty());
  EXPECT_TRUE(SmoothSky(sky, 16).is_constant());
  EXPECT_EQ(SmoothSky(sky, 16).luminance(kZenith), Rgb(1, 2, 3));
  EXPECT_FALSE(SmoothSky(sky, 16).is_black());
  EXPECT_TRUE(SmoothSky(Sky{}, 16).is_black());
}

TEST(SkyParts, AGentleSkyIsAllSmooth) { EXPECT_TRUE(BrightSky(gradient()).empty()); }

TEST(SkyParts, TheLimitIsAMultipleOfTheMeanBelowIt) {
  // A share s of the sphere is far above: limit = k ((1 - s) 1 + s limit), so limit = k (1 - s) / (1 - k s).
  for (const int width : {64, 256}) {
    Sky sky = sky_of(width, [](const glm::vec3& d) { return d.y > 0.8F ? 1e6F : 1.0F; });
    double share = 0.0;
    for (int row = 0; row < sky.height; ++row) {
      const Rgb& first = sky.map[static_cast<std::size_t>(row) * static_cast<std::size_t>(width)];
      if (first.x > 1.0F) share += width * texel_solid_angle(sky, row) / (4.0 * std::numbers::pi);
    }
    const double expected = kBrightness * (1.0 - share) / (1.0 - kBrightness * share);
    EXPECT_NEAR(double{bright_limit(sky)} / expected, 1.0, 0.02);
  }
}

TEST(SkyParts, WithLittleLightAllOfItIsBright) {
  const Sky sky = bright_skies()["sun alone"];
  EXPECT_EQ(bright_limit(sky), 0.0F);
  EXPECT_TRUE(SmoothSky(sky, 16).is_black());
  EXPECT_NEAR(glm::length(BrightSky(sky).illuminance() - Rgb(30, 20, 10)), 0.0F, 1e-4F);
}

TEST(SkyParts, LightASurfaceAndItsBackAsTheSkyDoes) {
  for (const auto& [name, sky] : bright_skies()) {
    const SmoothSky smooth(sky, 16);
    const BrightSky bright(sky);
    EXPECT_FALSE(bright.empty()) << name;
    const double flux = 4.0 * std::numbers::pi * double{luminance_of(mean_luminance(sky))};
    for (const glm::vec3 normal : {glm::vec3(1, 0, 0), kZenith, glm::vec3(0, 0, 1)}) {
      double net = 0.0;
      for (std::size_t t = 0; t < sky.map.size(); ++t) {
        net += glm::dot(texel_vector(sky, t), glm::dvec3(normal)) * double{luminance_of(sky.map[t])};
      }
      const auto from = [&](const glm::vec3& d) { return luminance_of(smooth.luminance(d)) * glm::dot(d, normal); };
      const double seen = integral([&](const glm::vec3& d) { return glm::vec3(from(d)); }).x;
      const double sent = unoccluded(bright, normal) - unoccluded(bright, -normal);
      EXPECT_NEAR((seen + sent - net) / flux, 0.0, 2e-3) << name;
    }
  }
}

TEST(SkyParts, KeepTheFluxToAThousandth) {
  for (const auto& [name, sky] : bright_skies()) {
    const BrightSky bright(sky);
    const SmoothSky smooth(sky, 16);
    const glm::dvec3 all = 4.0 * std::numbers::pi * glm::dvec3(mean_luminance(sky));
    const glm::dvec3 parts =
        integral([&](const glm::vec3& d) { return smooth.luminance(d); }) + glm::dvec3(bright.illuminance());
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(parts[band] / all[band], 1.0, 1e-3) << name;
  }
}

TEST(SkyParts, DirectionsBringTheUnoccludedLightOnAverage) {
  for (const auto& [name, sky] : bright_skies()) {
    const BrightSky bright(sky);
    std::vector<double> until;
    const double total = bright.weigh(kZenith, until);
    ASSERT_LE(until.size(), kMaxSkyGroups) << name;
    constexpr int kRays = 4096;
    double sum = 0.0, above = 0.0;
    for (int r = 0; r < kRays; ++r) {
      const ChosenDirection chosen = bright.choose(until, (r + 0.5) / kRays, {0.5F, 0.5F});
      sum += double{luminance_of(chosen.irradiance)} / kRays;
      above += chosen.direction.y > 0.0F ? 1.0 / kRays : 0.0;
      EXPECT_GT(luminance_of(luminance_towards(sky, chosen.direction)), bright_limit(sky)) << name;
    }
    EXPECT_NEAR(sum / total, 1.0, 1e-4) << name;
    EXPECT_GT(above, 0.97) << name;
  }
}

TEST(SkyParts, ASunHasItsColourAndItsCosine) {
  const Sky sky = bright_skies()["sun alone"];
  const BrightSky bright(sky);
  std::vector<double> until;
  bright.weigh(kZenith, until);
  const ChosenDirection chosen = bright.choose(until, 0.3, {0.5F, 0.5F});
  EXPECT_EQ(until.size(), 1U);
  for (int band = 0; band < 3; ++band) {
    EXPECT_NEAR(chosen.irradiance[band], (3.0F - static_cast<float>(band)) * 10.0F * chosen.direction.y, 0.01F);
  }
  EXPECT_EQ(bright.weigh(-kZenith, until), 0.0);
}

}  // namespace
}  // namespace radiosity
