#include "core/reconstruct/exposure.h"

#include <gtest/gtest.h>

#include <vector>

namespace radiosity {
namespace {

ExposureSample grey(float luminance, float area = 1.0F) { return {Rgb(luminance), area, false}; }
ExposureSample lamp(float luminance, float area = 1.0F) { return {Rgb(luminance), area, true}; }

TEST(AutomaticExposure, KeepsOneWhenTheSceneFitsIntoTheRange) {
  EXPECT_EQ(automatic_exposure(std::vector{grey(0.25F)}), 1.0F);
  EXPECT_EQ(automatic_exposure(std::vector{grey(0.6F)}), 1.0F);
  EXPECT_EQ(automatic_exposure(std::vector{grey(1.0F)}), 1.0F);
}

TEST(AutomaticExposure, BringsADarkSceneToNineTenths) {
  EXPECT_FLOAT_EQ(automatic_exposure(std::vector{grey(0.1F)}), 9.0F);
}

TEST(AutomaticExposure, BringsABrightSceneToNineTenths) {
  EXPECT_FLOAT_EQ(automatic_exposure(std::vector{grey(9.0F)}), 0.1F);
}

TEST(AutomaticExposure, ScalesInverselyWithTheLight) {
  const std::vector<ExposureSample> scene = {grey(3.0F), grey(7.0F, 2.0F), grey(20.0F, 5.0F)};
  std::vector<ExposureSample> brighter = scene;
  for (ExposureSample& sample : brighter) sample.luminance *= 8.0F;
  EXPECT_FLOAT_EQ(automatic_exposure(scene), 8.0F * automatic_exposure(brighter));
}

TEST(AutomaticExposure, LetsTheBrightestPercentOfTheAreaClip) {
  EXPECT_EQ(automatic_exposure(std::vector{grey(1000.0F, 0.5F), grey(0.5F, 99.5F)}), 1.0F);
  EXPECT_FLOAT_EQ(automatic_exposure(std::vector{grey(90.0F, 2.0F), grey(0.5F, 98.0F)}), 0.01F);
}

TEST(AutomaticExposure, CountsAreaNotSamples) {
  std::vector<ExposureSample> samples(100, grey(90.0F, 1e-4F));
  samples.push_back(grey(0.5F, 99.0F));
  EXPECT_EQ(automatic_exposure(samples), 1.0F);
}

TEST(AutomaticExposure, DoesNotCountLamps) {
  EXPECT_EQ(automatic_exposure(std::vector{lamp(1000.0F, 50.0F), grey(0.5F)}), 1.0F);
  EXPECT_FLOAT_EQ(automatic_exposure(std::vector{lamp(0.5F, 50.0F), grey(9.0F)}), 0.1F);
}

TEST(AutomaticExposure, LooksAtTheBrightestBand) {
  EXPECT_FLOAT_EQ(automatic_exposure(std::vector{ExposureSample{{0.0F, 0.1F, 9.0F}, 1.0F, false}}), 0.1F);
}

TEST(AutomaticExposure, IsOneWithoutLightOrSurface) {
  EXPECT_EQ(automatic_exposure({}), 1.0F);
  EXPECT_EQ(automatic_exposure(std::vector{grey(0.0F)}), 1.0F);
  EXPECT_EQ(automatic_exposure(std::vector{lamp(5.0F)}), 1.0F);
  EXPECT_EQ(automatic_exposure(std::vector{grey(5.0F, 0.0F)}), 1.0F);
}

TEST(ExposureFromEv100, HalvesWithEachStop) {
  EXPECT_FLOAT_EQ(exposure_from_ev100(0.0F), 1.0F / 1.2F);
  EXPECT_FLOAT_EQ(exposure_from_ev100(1.0F), 0.5F / 1.2F);
  EXPECT_FLOAT_EQ(exposure_from_ev100(-3.0F), 8.0F / 1.2F);
}

TEST(ClippedShare, CountsTheAreaAboveWhite) {
  const std::vector<ExposureSample> samples = {grey(0.5F, 3.0F), grey(2.0F, 1.0F)};
  EXPECT_FLOAT_EQ(clipped_share(samples, 1.0F), 0.25F);
  EXPECT_FLOAT_EQ(clipped_share(samples, 0.5F), 0.0F);
  EXPECT_FLOAT_EQ(clipped_share(samples, 4.0F), 1.0F);
}

TEST(ClippedShare, CountsLampsAndSingleBands) {
  const std::vector<ExposureSample> samples = {lamp(17.0F, 1.0F), {{0.0F, 0.0F, 1.5F}, 1.0F, false}, grey(0.5F, 2.0F)};
  EXPECT_FLOAT_EQ(clipped_share(samples, 1.0F), 0.5F);
}

TEST(ClippedShare, IsZeroWithoutSurface) { EXPECT_EQ(clipped_share({}, 1.0F), 0.0F); }

}  // namespace
}  // namespace radiosity
