#include "core/sky_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/core/test_skies.h"

namespace radiosity {
namespace {

using test::integral;
using test::sky_of;

/// Bright to one side, black below, and a sun.
Sky uneven_sky() {
  Sky sky = sky_of(32, [](const glm::vec3& d) { return std::max(0.0F, d.y) * (1.0F + d.x); });
  test::add_sun(sky, {0, 0.7F, 0.7F}, {2, 1, 0.5F});
  sky.map_from_world = map_turned_by(20.0);
  return sky;
}

/// The k-th of a sequence that fills the square evenly.
glm::vec2 place(int k) {
  const double x = 0.5 + k * 0.7548776662466927, y = 0.5 + k * 0.5698402909980532;
  return {std::min(x - std::floor(x), 0.999999), std::min(y - std::floor(y), 0.999999)};
}

TEST(SkySampler, DensityIntegratesToOne) {
  Sky constant;
  constant.luminance = Rgb(3.0F);
  const SkySampler uniform(constant);
  EXPECT_NEAR(integral([&](const glm::vec3& d) { return glm::vec3(uniform.pdf(d)); }).x, 1.0, 1e-6);
  const Sky sky = uneven_sky();
  const SkySampler sampler(sky);
  double sum = 0.0;
  for (std::size_t texel = 0; texel < sky.map.size(); ++texel) {
    sum += texel_solid_angle(sky, static_cast<int>(texel) / sky.width) *
           double{sampler.pdf(direction_in_texel(sky, texel, {0.5F, 0.5F}))};
  }
  EXPECT_NEAR(sum, 1.0, 1e-5);
}

TEST(SkySampler, SamplesSayTheirDensityAndLuminance) {
  const Sky sky = uneven_sky();
  const SkySampler sampler(sky);
  int same = 0;
  for (int k = 0; k < 1000; ++k) {
    const SkySample sample = sampler.sample(place(k));
    EXPECT_GT(sample.pdf, 0.0F);
    // At the edge of a texel rounding may find its neighbour.
    same += sample.luminance == luminance_towards(sky, sample.direction) && sample.pdf == sampler.pdf(sample.direction);
  }
  EXPECT_GE(same, 995);
}

TEST(SkySampler, SendsEachTexelItsShareOfTheLight) {
  const Sky sky = uneven_sky();
  const SkySampler sampler(sky);
  constexpr int kCount = 200'000;
  std::vector<int> hits(sky.map.size(), 0);
  for (int k = 0; k < kCount; ++k) ++hits[texel_towards(sky, sampler.sample(place(k)).direction)];
  for (std::size_t texel = 0; texel < sky.map.size(); ++texel) {
    const double share = texel_solid_angle(sky, static_cast<int>(texel) / sky.width) *
                         double{sampler.pdf(direction_in_texel(sky, texel, {0.5F, 0.5F}))};
    EXPECT_NEAR(hits[texel], share * kCount, 5.0 * std::sqrt(share * kCount) + 2.0) << texel;
  }
}

TEST(SkySampler, EstimatesTheIrradianceOfAPlane) {
  // L = y above the horizon: the integral of y^2 over the upper half is 2 pi / 3.
  const Sky sky = sky_of(256, [](const glm::vec3& d) { return std::max(0.0F, d.y); });
  const SkySampler sampler(sky);
  double sum = 0.0;
  constexpr int kCount = 20'000;
  for (int k = 0; k < kCount; ++k) {
    const SkySample sample = sampler.sample(place(k));
    sum += double{sample.luminance.y} * std::max(0.0, double{sample.direction.y}) / double{sample.pdf};
  }
  EXPECT_NEAR(sum / kCount, 2.0 * std::numbers::pi / 3.0, 0.002);
}

TEST(SkySampler, KeepsWithinTheRangeAtBothEndsOfTheSquare) {
  const Sky sky = uneven_sky();
  const SkySampler sampler(sky);
  constexpr float kLast = 0x1.fffffep-1F;
  for (const glm::vec2 corner : {glm::vec2(0.0F), glm::vec2(kLast, 0.0F), glm::vec2(0.0F, kLast), glm::vec2(kLast)}) {
    EXPECT_GT(sampler.sample(corner).pdf, 0.0F);
  }
}

TEST(SkySampler, HasNothingToSampleOfABlackSky) {
  const Sky black = sky_of(8, [](const glm::vec3&) { return 0.0F; });
  for (const Sky& sky : {Sky{}, black}) {
    const SkySampler sampler(sky);
    EXPECT_TRUE(sampler.is_black());
    EXPECT_EQ(sampler.sample({0.5F, 0.5F}).pdf, 0.0F);
    EXPECT_EQ(sampler.pdf({0, 1, 0}), 0.0F);
  }
}

}  // namespace
}  // namespace radiosity
