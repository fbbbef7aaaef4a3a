#include "core/verify/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace radiosity {
namespace {

ComparedPlace grey_place(float reference, float displayed) { return {Rgb(reference), Rgb(displayed)}; }

TEST(Compare, WhatIsRightUpToExposureHasNoError) {
  const std::vector<ComparedPlace> places = {grey_place(2.0F, 0.5F), grey_place(1.0F, 0.25F), grey_place(0.0F, 0.0F)};
  EXPECT_NEAR(fitted_exposure(places), 0.25, 1e-6);
  const Comparison result = compare(places, 0.25);
  EXPECT_NEAR(result.relative_rmse, 0.0, 1e-6);
  EXPECT_NEAR(result.p99, 0.0, 1e-6);
  EXPECT_NEAR(result.mean, 1.0, 1e-6);
}

TEST(Compare, NumbersMadeByHand) {
  // Errors of 0.1 and -0.2 around a mean of 1.5.
  const std::vector<ComparedPlace> places = {grey_place(1.0F, 1.1F), grey_place(2.0F, 1.8F)};
  const Comparison result = compare(places, 1.0);
  EXPECT_NEAR(result.relative_rmse, std::sqrt((0.01 + 0.04) / 2.0) / 1.5, 1e-6);
  EXPECT_NEAR(relative_error(places[0], 1.0, result.mean), 0.1 / 1.15, 1e-6);
  EXPECT_NEAR(relative_error(places[1], 1.0, result.mean), -0.2 / 2.15, 1e-6);
  EXPECT_NEAR(result.p95, 0.2 / 2.15, 1e-6);
  EXPECT_EQ(result.reference_noise, 0.0);
  EXPECT_EQ(result.clipped_share, 0.0);
}

TEST(Compare, PercentilesCountPlaces) {
  std::vector<ComparedPlace> places(96, grey_place(1.0F, 1.0F));
  places.insert(places.end(), 3, grey_place(1.0F, 1.11F));
  places.push_back(grey_place(1.0F, 2.1F));
  const Comparison result = compare(places, 1.0);
  EXPECT_NEAR(result.median, 0.0, 1e-6);
  EXPECT_NEAR(result.p95, 0.0, 1e-6);
  EXPECT_NEAR(result.p99, 1.0, 1e-5);
}

TEST(Compare, TheNoiseOfTheReferenceIsTakenOut) {
  std::vector<ComparedPlace> places = {grey_place(1.1F, 1.0F), grey_place(0.9F, 1.0F)};
  for (ComparedPlace& place : places) place.variance = 0.0064;
  const Comparison result = compare(places, 1.0);
  EXPECT_NEAR(result.reference_noise, 0.08, 1e-6);
  EXPECT_NEAR(result.relative_rmse, 0.06, 1e-6);
}

TEST(Compare, TheNoiseOfTheReferenceDoesNotLowerTheExposure) {
  // The truth is 1 everywhere, but seen with a variance of 0.25 per band.
  std::vector<ComparedPlace> places = {grey_place(1.5F, 1.0F), grey_place(0.5F, 1.0F)};
  for (ComparedPlace& place : places) place.band_variance = 3.0 * 0.25;
  EXPECT_NEAR(fitted_exposure(places), 1.0, 1e-6);
}

TEST(Compare, WhatWhiteCannotShowIsNoError) {
  ComparedPlace lamp = grey_place(40.0F, 1.0F);
  lamp.clipped = true;
  const std::vector<ComparedPlace> places = {lamp, grey_place(0.8F, 0.4F)};
  EXPECT_NEAR(fitted_exposure(places), 0.5, 1e-6);
  const Comparison result = compare(places, 0.5);
  EXPECT_NEAR(result.relative_rmse, 0.0, 1e-6);
  EXPECT_NEAR(result.mean, (2.0 + 0.8) / 2.0, 1e-6);
  EXPECT_EQ(result.clipped_share, 0.5);
}

TEST(Compare, ASceneThatIsBlackEverywhereIsRightOrWholly) {
  const std::vector<ComparedPlace> dark = {grey_place(0.0F, 0.0F)}, lit = {grey_place(0.0F, 0.5F)};
  EXPECT_EQ(compare(dark, fitted_exposure(dark)).relative_rmse, 0.0);
  EXPECT_EQ(compare(lit, fitted_exposure(lit)).relative_rmse, 1.0);
}

}  // namespace
}  // namespace radiosity
