#include "plugin/interpolate_attributes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <numeric>

namespace gltf_radiosity {
namespace {

using radiosity::Cut;

using testing::ElementsAre;
using testing::FloatNear;
using testing::Pointwise;

const std::vector<Cut> kMiddle = {{{0, 1}, 0.5F}};

RawAccessor raw_of(const std::vector<float>& values, int components, ComponentType component = ComponentType::kF32,
                   bool normalized = false) {
  return {component, components, normalized, values.size() / static_cast<std::size_t>(components),
          encode_floats(values, component, normalized)};
}

/// The row after the two that midpoints are taken of.
std::vector<float> third_row(const RawAccessor& raw) {
  const std::vector<float> values = as_floats(raw);
  const auto width = static_cast<std::ptrdiff_t>(raw.components);
  return {values.begin() + 2 * width, values.begin() + 3 * width};
}

std::vector<float> midpoint(RawAccessor raw, Interpolation how) {
  append_cuts(raw, how, kMiddle);
  EXPECT_EQ(raw.count, 3U);
  return third_row(raw);
}

TEST(InterpolateAttributes, GoesByTheDistanceFromBothEnds) {
  const std::vector<Cut> near_second = {{{0, 1}, 0.75F}};
  RawAccessor linear = raw_of({0, 8, 4, 0}, 2);
  append_cuts(linear, Interpolation::kLinear, near_second);
  EXPECT_THAT(third_row(linear), ElementsAre(3, 2));

  RawAccessor ids = raw_of({7, 9}, 1, ComponentType::kU16);
  append_cuts(ids, Interpolation::kLabel, near_second);
  EXPECT_THAT(third_row(ids), ElementsAre(9)) << "of the nearer end";

  RawAccessor tangent = raw_of({1, 0, 0, -1, 0, 1, 0, 1}, 4);
  append_cuts(tangent, Interpolation::kTangent, near_second);
  EXPECT_THAT(third_row(tangent), ElementsAre(FloatNear(0.3162278F, 1e-6F), FloatNear(0.9486833F, 1e-6F), 0, 1));

  std::vector<SkinSet> skin = {
      {raw_of({5, 0, 0, 0, 6, 0, 0, 0}, 4, ComponentType::kU8), raw_of({1, 0, 0, 0, 1, 0, 0, 0}, 4)}};
  append_cuts(skin, near_second);
  EXPECT_THAT(third_row(skin[0].joints), ElementsAre(6, 5, 0, 0));
  EXPECT_THAT(third_row(skin[0].weights), ElementsAre(0.75F, 0.25F, 0, 0));
}

TEST(InterpolateAttributes, AMidpointIsTheMeanOfItsEnds) {
  EXPECT_THAT(midpoint(raw_of({0, 1, 4, 3}, 2), Interpolation::kLinear), ElementsAre(2, 2));
}

TEST(InterpolateAttributes, IntegersAreRoundedToTheNearest) {
  EXPECT_THAT(midpoint(raw_of({-3, 4}, 1, ComponentType::kI16), Interpolation::kLinear), ElementsAre(1));
  const RawAccessor bytes{ComponentType::kU8, 1, true, 2, {10, 20}};
  EXPECT_THAT(midpoint(bytes, Interpolation::kLinear), ElementsAre(FloatNear(15.0F / 255.0F, 1e-6F)));
}

TEST(InterpolateAttributes, ExistingBytesStayWhateverTheyAre) {
  RawAccessor raw = raw_of({1, 2, 3, 4}, 2);
  const std::uint32_t odd_nan = 0x7fc12345U;
  std::memcpy(raw.bytes.data() + 4, &odd_nan, 4);
  const Bytes before = raw.bytes;
  append_cuts(raw, Interpolation::kLinear, kMiddle);
  EXPECT_TRUE(std::equal(before.begin(), before.end(), raw.bytes.begin()));
}

TEST(InterpolateAttributes, MidpointsOfMidpointsAreNotRoundedInBetween) {
  RawAccessor raw{ComponentType::kU8, 1, false, 2, {0, 1}};
  append_cuts(raw, Interpolation::kLinear, std::vector<Cut>{{{0, 1}, 0.5F}, {{2, 1}, 0.5F}, {{3, 1}, 0.5F}});
  EXPECT_EQ(raw.bytes, (Bytes{0, 1, 1, 1, 1}));
  RawAccessor low{ComponentType::kU8, 1, false, 2, {0, 1}};
  append_cuts(low, Interpolation::kLinear, std::vector<Cut>{{{0, 1}, 0.5F}, {{2, 0}, 0.5F}, {{3, 0}, 0.5F}});
  EXPECT_EQ(low.bytes, (Bytes{0, 1, 1, 0, 0}));  // 0.5, 0.25, 0.125
}

TEST(InterpolateAttributes, NormalsKeepUnitLength) {
  const float half = std::sqrt(0.5F);
  EXPECT_THAT(midpoint(raw_of({1, 0, 0, 0, 1, 0}, 3), Interpolation::kDirection),
              Pointwise(FloatNear(1e-6F), {half, half, 0.0F}));
}

TEST(InterpolateAttributes, OppositeNormalsTakeTheFirst) {
  EXPECT_THAT(midpoint(raw_of({0, 0, 1, 0, 0, -1}, 3), Interpolation::kDirection), ElementsAre(0, 0, 1));
}

TEST(InterpolateAttributes, WhatIsNoNumberDoesNotSpread) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(midpoint(raw_of({nan, 3, 5, nan}, 2), Interpolation::kLinear), ElementsAre(5, 3));
  EXPECT_THAT(midpoint(raw_of({nan, nan, nan, 0, 0, 1}, 3), Interpolation::kDirection), ElementsAre(0, 0, 1));
}

TEST(InterpolateAttributes, TangentsKeepTheSignOfTheFirstEnd) {
  const float half = std::sqrt(0.5F);
  EXPECT_THAT(midpoint(raw_of({1, 0, 0, -1, 0, 0, 1, 1}, 4), Interpolation::kTangent),
              Pointwise(FloatNear(1e-6F), {half, 0.0F, half, -1.0F}));
}

TEST(InterpolateAttributes, LabelsAreNotAveraged) {
  const RawAccessor ids = raw_of({7, 9}, 1, ComponentType::kU16);
  EXPECT_EQ(interpolation_of("_FEATURE_ID_0", ids), Interpolation::kLabel);
  EXPECT_THAT(midpoint(ids, Interpolation::kLabel), ElementsAre(7));
}

TEST(InterpolateAttributes, EverySemanticHasItsWay) {
  const RawAccessor vec3 = raw_of({0, 0, 0}, 3), vec4 = raw_of({0, 0, 0, 0}, 4);
  EXPECT_EQ(interpolation_of("POSITION", vec3), Interpolation::kLinear);
  EXPECT_EQ(interpolation_of("POSITION", raw_of({0, 0, 0}, 3, ComponentType::kI16)), Interpolation::kLinear);
  EXPECT_EQ(interpolation_of("NORMAL", vec3), Interpolation::kDirection);
  EXPECT_EQ(interpolation_of("TANGENT", vec4), Interpolation::kTangent);
  EXPECT_EQ(interpolation_of("TEXCOORD_1", raw_of({0, 0}, 2)), Interpolation::kLinear);
  EXPECT_EQ(interpolation_of("_HEAT", raw_of({0}, 1)), Interpolation::kLinear);
}

TEST(InterpolateAttributes, PickingRepeatsRows) {
  const RawAccessor picked_rows = picked(raw_of({1, 2, 3, 4, 5, 6}, 2), std::vector<std::uint32_t>{2, 0, 2});
  EXPECT_THAT(as_floats(picked_rows), ElementsAre(5, 6, 1, 2, 5, 6));
  EXPECT_EQ(picked(raw_of({1, 2}, 1), {}).count, 2U);
}

// Skins.

SkinSet skin(const std::vector<float>& joints, const std::vector<float>& weights,
             ComponentType weight_type = ComponentType::kF32) {
  return {raw_of(joints, 4, ComponentType::kU8), raw_of(weights, 4, weight_type, weight_type != ComponentType::kF32)};
}

TEST(InterpolateAttributes, InfluencesOfBothEndsAreMerged) {
  std::vector<SkinSet> sets = {skin({1, 2, 0, 0, 2, 0, 0, 0}, {0.5F, 0.5F, 0, 0, 1, 0, 0, 0})};
  append_cuts(sets, kMiddle);
  EXPECT_THAT(third_row(sets[0].joints), ElementsAre(2, 1, 0, 0));
  EXPECT_THAT(third_row(sets[0].weights), ElementsAre(0.75F, 0.25F, 0, 0));
}

TEST(InterpolateAttributes, TheStrongestFourInfluencesAreKept) {
  std::vector<SkinSet> sets = {skin({1, 2, 3, 4, 5, 6, 7, 8}, {0.4F, 0.3F, 0.2F, 0.1F, 0.4F, 0.3F, 0.2F, 0.1F})};
  append_cuts(sets, kMiddle);
  EXPECT_THAT(third_row(sets[0].joints), ElementsAre(1, 5, 2, 6));
  EXPECT_THAT(third_row(sets[0].weights),
              Pointwise(FloatNear(1e-6F), {0.4F / 1.4F, 0.4F / 1.4F, 0.3F / 1.4F, 0.3F / 1.4F}));
}

TEST(InterpolateAttributes, TwoSetsKeepEightInfluences) {
  const std::vector<float> quarters(8, 0.125F);
  std::vector<SkinSet> sets = {skin({1, 2, 3, 4, 5, 6, 7, 8}, quarters), skin({9, 10, 11, 12, 1, 2, 3, 4}, quarters)};
  append_cuts(sets, kMiddle);
  EXPECT_THAT(third_row(sets[0].joints), ElementsAre(1, 2, 3, 4));  // on both ends
  EXPECT_THAT(third_row(sets[1].joints), ElementsAre(5, 6, 7, 8));
  std::vector<float> weights = third_row(sets[0].weights);
  const std::vector<float> more = third_row(sets[1].weights);
  weights.insert(weights.end(), more.begin(), more.end());
  EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0F), 1.0F, 1e-6F);
}

TEST(InterpolateAttributes, StoredBytesOfWeightsAddUpToOne) {
  std::vector<SkinSet> sets = {
      skin({1, 2, 3, 0, 4, 5, 6, 0}, {1.0F / 3, 1.0F / 3, 1.0F / 3, 0, 0.9F, 0.05F, 0.05F, 0}, ComponentType::kU8)};
  append_cuts(sets, kMiddle);
  const Bytes& bytes = sets[0].weights.bytes;
  EXPECT_EQ(std::accumulate(bytes.begin() + 8, bytes.end(), 0), 255);
}

TEST(InterpolateAttributes, AJointWithoutWeightIsZero) {
  std::vector<SkinSet> sets = {skin({3, 4, 0, 0, 3, 0, 0, 0}, {0.999F, 0.001F, 0, 0, 1, 0, 0, 0}, ComponentType::kU16)};
  sets[0].weights = raw_of({0.999F, 0.001F, 0, 0, 1, 0, 0, 0}, 4, ComponentType::kU8, true);
  append_cuts(sets, kMiddle);
  EXPECT_THAT(third_row(sets[0].joints), ElementsAre(3, 0, 0, 0));
  EXPECT_THAT(third_row(sets[0].weights), ElementsAre(1, 0, 0, 0));
}

TEST(InterpolateAttributes, AVertexWithoutInfluencesHasNone) {
  std::vector<SkinSet> sets = {skin({5, 0, 0, 0, 6, 0, 0, 0}, std::vector<float>(8, 0.0F))};
  append_cuts(sets, kMiddle);
  EXPECT_THAT(third_row(sets[0].joints), ElementsAre(0, 0, 0, 0));
  EXPECT_THAT(third_row(sets[0].weights), ElementsAre(0, 0, 0, 0));
}

}  // namespace
}  // namespace gltf_radiosity
