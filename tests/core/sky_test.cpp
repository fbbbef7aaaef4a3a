#include "core/sky.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "tests/core/test_skies.h"

namespace radiosity {
namespace {

using test::sky_of;
using testing::HasSubstr;

/// A map whose texels are told apart by their red band.
Sky numbered_sky(int width) {
  Sky sky = sky_of(width, [](const glm::vec3&) { return 0.0F; });
  for (std::size_t k = 0; k < sky.map.size(); ++k) sky.map[k].x = static_cast<float>(k);
  return sky;
}

glm::vec3 at_azimuth(double degrees) {
  const double angle = degrees * std::numbers::pi / 180.0;
  return {std::sin(angle), 0.0, std::cos(angle)};
}

TEST(Sky, ShowsOneLuminanceWithoutAMap) {
  Sky sky;
  sky.luminance = {1, 2, 3};
  EXPECT_FALSE(sky.has_map());
  EXPECT_EQ(luminance_towards(sky, {0, -1, 0}), Rgb(1, 2, 3));
  EXPECT_EQ(mean_luminance(sky), Rgb(1, 2, 3));
}

TEST(Sky, MiddleOfTheMapIsPlusXAndPlusZIsToTheRight) {
  const Sky sky = numbered_sky(8);
  const auto column = [&](const glm::vec3& direction) { return texel_towards(sky, direction) % 8; };
  const auto row = [&](const glm::vec3& direction) { return texel_towards(sky, direction) / 8; };
  // A little to the right of each direction, which itself is the edge of a column.
  EXPECT_EQ(column({1, 0, 0.1F}), 4U);
  EXPECT_EQ(column({-0.1F, 0, 1}), 6U);
  EXPECT_EQ(column({-1, 0, -0.1F}), 0U);
  EXPECT_EQ(column({0.1F, 0, -1}), 2U);
  EXPECT_EQ(row({0, 1, 0}), 0U);
  EXPECT_EQ(row(glm::normalize(glm::vec3(1, 0.1F, 0))), 1U);
  EXPECT_EQ(row(glm::normalize(glm::vec3(1, -0.1F, 0))), 2U);
  EXPECT_EQ(row({0, -1, 0}), 3U);
}

TEST(Sky, ColumnsCountTheAzimuthDown) {
  const Sky sky = numbered_sky(360);
  const auto row = static_cast<std::size_t>(90 * 360);
  for (int column = 0; column < 360; ++column) {
    const double azimuth = 270.0 - (column + 0.5);
    EXPECT_EQ(texel_towards(sky, at_azimuth(azimuth)) % row, static_cast<std::size_t>(column)) << azimuth;
  }
}

TEST(Sky, DirectionsInATexelLeadBackToIt) {
  Sky sky = numbered_sky(12);
  sky.map_from_world = map_turned_by(33.0);
  for (std::size_t texel = 0; texel < sky.map.size(); ++texel) {
    for (const glm::vec2 place : {glm::vec2(0.01F, 0.01F), glm::vec2(0.99F, 0.01F), glm::vec2(0.5F, 0.99F)}) {
      const glm::vec3 direction = direction_in_texel(sky, texel, place);
      EXPECT_NEAR(glm::length(direction), 1.0F, 1e-6F);
      EXPECT_EQ(texel_towards(sky, direction), texel);
      EXPECT_EQ(luminance_towards(sky, direction).x, static_cast<float>(texel));
    }
  }
}

TEST(Sky, TexelsFillTheSphere) {
  const Sky sky = numbered_sky(12);
  double angle = 0.0;
  glm::dvec3 above(0.0), all(0.0);
  for (std::size_t texel = 0; texel < sky.map.size(); ++texel) {
    angle += texel_solid_angle(sky, static_cast<int>(texel) / 12);
    all += texel_vector(sky, texel);
    if (texel < sky.map.size() / 2) above += texel_vector(sky, texel);
  }
  EXPECT_NEAR(angle, 4.0 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(glm::length(all), 0.0, 1e-12);
  EXPECT_NEAR(glm::length(above - glm::dvec3(0.0, std::numbers::pi, 0.0)), 0.0, 1e-12)
      << "the irradiance from half a sphere is pi L";
}

TEST(Sky, VectorOfASmallTexelIsItsSolidAngleTimesItsDirection) {
  Sky sky = numbered_sky(1024);
  sky.map_from_world = map_turned_by(10.0);
  for (const std::size_t texel : {std::size_t{100'000}, std::size_t{333'333}}) {
    const double angle = texel_solid_angle(sky, static_cast<int>(texel / 1024));
    const glm::dvec3 expected = angle * glm::dvec3(direction_in_texel(sky, texel, {0.5F, 0.5F}));
    EXPECT_NEAR(glm::length(texel_vector(sky, texel) - expected), 0.0, 1e-4 * angle);
  }
}

TEST(Sky, MeanIsWeightedBySolidAngle) {
  EXPECT_NEAR(mean_luminance(sky_of(64, [](const glm::vec3&) { return 2.0F; })).x, 2.0F, 1e-6F);
  // y^2 over the sphere is 1/3.
  EXPECT_NEAR(mean_luminance(sky_of(512, [](const glm::vec3& d) { return d.y * d.y; })).y, 1.0 / 3.0, 1e-4);
}

TEST(Sky, TurnsTowardsLargerAzimuth) {
  for (const double degrees : {0.0, 30.0, 90.0, -135.0, 720.0}) {
    Sky sky = sky_of(360, [](const glm::vec3&) { return 0.0F; });
    sky.map[texel_towards(sky, at_azimuth(40.5))] = Rgb(1.0F);
    sky.map_from_world = map_turned_by(degrees);
    EXPECT_EQ(luminance_towards(sky, at_azimuth(40.5 + degrees)), Rgb(1.0F)) << degrees;
    EXPECT_EQ(validate(sky), std::nullopt);
  }
}

TEST(Sky, IsRefusedIfItMakesNoSense) {
  const auto fault_after = [](const auto& change) {
    Sky sky = numbered_sky(4);
    change(sky);
    return validate(sky).value_or("nothing is wrong");
  };
  EXPECT_EQ(fault_after([](Sky&) {}), "nothing is wrong");
  EXPECT_THAT(fault_after([](Sky& s) { s.luminance.y = -1.0F; }), HasSubstr("negative"));
  EXPECT_THAT(fault_after([](Sky& s) { s.map[3].z = -1.0F; }), HasSubstr("map is negative"));
  EXPECT_THAT(fault_after([](Sky& s) { s.map[3].z = std::numeric_limits<float>::infinity(); }), HasSubstr("finite"));
  EXPECT_THAT(fault_after([](Sky& s) { s.map.pop_back(); }), HasSubstr("large"));
  EXPECT_THAT(fault_after([](Sky& s) { s.width = s.height = -1; }), HasSubstr("large"));
  EXPECT_THAT(fault_after([](Sky& s) { s.map_from_world[0][0] = 2.0F; }), HasSubstr("rotation"));
}

}  // namespace
}  // namespace radiosity
