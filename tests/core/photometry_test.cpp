#include "core/photometry.h"

#include <gtest/gtest.h>

#include <numbers>

namespace radiosity {
namespace {

constexpr Rgb kColour(0.25F, 1.0F, 4.0F);

void expect_near(const Rgb& actual, const Rgb& expected) {
  for (int band = 0; band < 3; ++band) EXPECT_NEAR(actual[band], expected[band], 1e-6F * expected[band]);
}

TEST(Photometry, ALuminousSurfaceLeavesPiTimesItsLuminance) {
  EXPECT_FLOAT_EQ(exitance_of_luminance(Rgb(1.0F)).x, std::numbers::pi_v<float>);
}

TEST(Photometry, LuminanceOfRadiosityUndoesExitanceOfLuminance) {
  expect_near(luminance_of_radiosity(exitance_of_luminance(kColour)), kColour);
}

TEST(Photometry, AWhiteSurfaceUnderAUniformSkyShowsTheSky) {
  expect_near(reflected_luminance(Rgb(1.0F), irradiance_of_luminance(kColour, 1.0F)), kColour);
}

TEST(Photometry, OneLuxOnWhiteShowsOneOverPi) {
  EXPECT_FLOAT_EQ(reflected_luminance(Rgb(1.0F), Rgb(1.0F)).y, std::numbers::inv_pi_v<float>);
}

TEST(Photometry, IrradianceIsProportionalToTheShareOfTheView) {
  expect_near(irradiance_of_luminance(kColour, 0.25F), 0.25F * irradiance_of_luminance(kColour, 1.0F));
}

TEST(Photometry, ReflectanceActsOnEachBandAlone) {
  EXPECT_EQ(reflected_luminance(Rgb(0.0F, 1.0F, 0.0F), kColour).x, 0.0F);
  EXPECT_GT(reflected_luminance(Rgb(0.0F, 1.0F, 0.0F), kColour).y, 0.0F);
}

TEST(Photometry, WeighsTheBandsAsTheEyeDoes) {
  EXPECT_FLOAT_EQ(luminance_of(Rgb(1.0F)), 1.0F);
  EXPECT_GT(luminance_of({0, 1, 0}), luminance_of({1, 0, 0}));
  EXPECT_GT(luminance_of({1, 0, 0}), luminance_of({0, 0, 1}));
}

}  // namespace
}  // namespace radiosity
