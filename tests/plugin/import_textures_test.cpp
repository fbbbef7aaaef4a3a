#include "plugin/import_textures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <random>

#include "tests/plugin/gltf_builder.h"

namespace gltf_radiosity {
namespace {

using Triangle = std::array<glm::vec2, 3>;

constexpr Triangle kLowerHalf = {{{0, 0}, {0, 1}, {1, 1}}};
constexpr Triangle kUpperHalf = {{{0, 0}, {1, 1}, {1, 0}}};

/// A document with one image, and slots of it.
class TextureFixture {
 public:
  TextureFixture(int width, int height, const std::vector<std::uint8_t>& rgba) {
    builder_.add_texture(width, height, rgba);
    document_ = builder_.document();
  }
  TextureSlot slot(TexelKind kind = TexelKind::kData, const Json& info = {{"index", 0}}) {
    std::vector<Warning> warnings;
    auto slot = TextureLibrary(document_, warnings).slot(info, kind);
    EXPECT_TRUE(slot) << slot.error().text();
    return *slot;
  }

 private:
  GltfBuilder builder_;
  Document document_;
};

/// [height * width * 4] random numbers, opaque.
std::vector<std::uint8_t> noise(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::uint8_t> rgba;
  for (int i = 0; i < width * height; ++i) {
    for (int band = 0; band < 3; ++band) rgba.push_back(static_cast<std::uint8_t>(random() & 255U));
    rgba.push_back(255);
  }
  return rgba;
}

double mean_red(const std::vector<std::uint8_t>& rgba) {
  double sum = 0;
  for (std::size_t i = 0; i < rgba.size(); i += 4) sum += rgba[i] / 255.0;
  return sum / (static_cast<double>(rgba.size()) / 4);
}

TEST(Textures, AnEmptySlotIsWhite) {
  EXPECT_EQ(TextureSlot().at({0.3F, 0.7F}), glm::vec4(1.0F));
  EXPECT_EQ(TextureSlot().mean(kLowerHalf), glm::vec4(1.0F));
}

TEST(Textures, TheMeanOfASquareIsTheMeanOfItsTexels) {
  for (const glm::ivec2 size : {glm::ivec2(1, 1), {2, 2}, {3, 5}, {16, 16}, {17, 9}, {64, 1}, {100, 333}, {512, 512}}) {
    const auto rgba = noise(size.x, size.y, 7);
    const TextureSlot slot = TextureFixture(size.x, size.y, rgba).slot();
    const double mean = (slot.mean(kLowerHalf).x + slot.mean(kUpperHalf).x) / 2;
    EXPECT_NEAR(mean, mean_red(rgba), 0.002) << size.x << " x " << size.y;
  }
}

TEST(Textures, OneTriangleOverManyPeriodsSeesTheMeanOfTheImage) {
  const auto rgba = noise(32, 32, 3);
  const TextureSlot slot = TextureFixture(32, 32, rgba).slot();
  for (const float repeats : {64.0F, 1000.0F}) {
    const Triangle large = {{{0, 0}, {0, repeats}, {repeats, 0}}};
    EXPECT_NEAR(slot.mean(large).x, mean_red(rgba), 0.01 * mean_red(rgba)) << repeats;
  }
}

TEST(Textures, TexelsCountByTheAreaTheyCover) {
  // Left texel 0, right texel 1: the mean over a triangle is the share of it beyond the middle.
  const TextureSlot slot = TextureFixture(2, 1, {0, 0, 0, 255, 255, 255, 255, 255}).slot();
  EXPECT_NEAR(slot.mean({{{0, 0}, {1, 0}, {0, 1}}}).x, 0.25F, 1e-5F);
  EXPECT_NEAR(slot.mean({{{0, 0}, {0, 1}, {1, 0}}}).x, 0.25F, 1e-5F) << "either way round";
  EXPECT_NEAR(slot.mean({{{0.4F, 0}, {0.6F, 0}, {0.5F, 1}}}).x, 0.5F, 1e-4F);
  EXPECT_NEAR(slot.mean({{{0.1F, 0.2F}, {0.2F, 0.2F}, {0.1F, 0.7F}}}).x, 0.0F, 1e-6F);
}

TEST(Textures, APartOfATriangleAndTheRestAddUpToTheWhole) {
  const TextureSlot slot = TextureFixture(8, 8, noise(8, 8, 11)).slot();
  const Triangle whole = {{{0.1F, 0.05F}, {0.9F, 0.3F}, {0.35F, 0.95F}}};
  const glm::vec2 a = (whole[0] + whole[1]) / 2.0F, b = (whole[1] + whole[2]) / 2.0F, c = (whole[2] + whole[0]) / 2.0F;
  const glm::vec4 parts =
      (slot.mean({whole[0], a, c}) + slot.mean({a, whole[1], b}) + slot.mean({c, b, whole[2]}) + slot.mean({a, b, c})) /
      4.0F;
  EXPECT_NEAR(parts.x, slot.mean(whole).x, 1e-4F);
}

TEST(Textures, TheMeanAgreesWithDenseSampling) {
  const auto rgba = noise(64, 64, 13);
  const TextureSlot slot = TextureFixture(64, 64, rgba).slot();
  const auto dense = [&](const Triangle& uv) {
    constexpr int kSteps = 400;
    double sum = 0;
    for (int j = 0; j < kSteps; ++j) {
      for (int i = 0; i < kSteps - j; ++i) {
        const float s = (static_cast<float>(i) + 0.3F) / kSteps, t = (static_cast<float>(j) + 0.3F) / kSteps;
        const glm::ivec2 texel(glm::floor((uv[0] + s * (uv[1] - uv[0]) + t * (uv[2] - uv[0])) * 64.0F));
        sum += rgba[static_cast<std::size_t>((texel.y & 63) * 64 + (texel.x & 63)) * 4] / 255.0;
      }
    }
    return sum / (kSteps * (kSteps + 1) / 2);
  };
  const Triangle inside = {{{0.1F, 0.1F}, {0.2F, 0.12F}, {0.15F, 0.19F}}};
  EXPECT_NEAR(slot.mean(inside).x, dense(inside), 0.004) << "small: exact texels";
  const Triangle large = {{{-0.4F, 0.1F}, {1.2F, 0.3F}, {0.3F, 1.7F}}};
  EXPECT_NEAR(slot.mean(large).x, dense(large), 0.01) << "large: a coarser level";
}

TEST(Textures, ColorsAreAveragedInLinearLight) {
  // Black and white: linear 0.5, whereas the mean of the codes would be 0.21.
  const TextureSlot slot = TextureFixture(2, 1, {0, 0, 0, 255, 255, 255, 255, 255}).slot(TexelKind::kColor);
  EXPECT_NEAR((slot.mean(kLowerHalf).x + slot.mean(kUpperHalf).x) / 2, 0.5F, 1e-4F);
  const TextureSlot gray = TextureFixture(1, 1, {188, 188, 188, 128}).slot(TexelKind::kColor);
  EXPECT_NEAR(gray.at({0.5F, 0.5F}).x, 0.5029F, 1e-3F);
  EXPECT_NEAR(gray.at({0.5F, 0.5F}).w, 128.0F / 255.0F, 1e-6F) << "alpha is never sRGB";
}

TEST(Textures, WhatIsNotCoveredHasNoSayInTheColor) {
  const std::vector<std::uint8_t> rgba = {255, 0, 0, 255, 0, 0, 255, 0};
  const TextureSlot covered = TextureFixture(2, 1, rgba).slot(TexelKind::kCoveredColor);
  const TextureSlot plain = TextureFixture(2, 1, rgba).slot(TexelKind::kColor);
  EXPECT_NEAR(covered.mean(kLowerHalf).x, 1.0F, 1e-4F);
  EXPECT_NEAR(covered.mean(kLowerHalf).w + covered.mean(kUpperHalf).w, 1.0F, 1e-4F) << "half of the area is there";
  EXPECT_NEAR(plain.mean(kLowerHalf).x + plain.mean(kUpperHalf).x, 1.0F, 1e-4F);
}

TEST(Textures, WrapModesDecideWhatLiesOutside) {
  GltfBuilder builder;
  builder.add_texture(2, 1, {0, 0, 0, 255, 255, 255, 255, 255});
  const auto value = [&](int wrap, float u) {
    builder.json["samplers"] = Json::array({Json{{"wrapS", wrap}}});
    builder.json["textures"][0]["sampler"] = 0;
    const Document document = builder.document();
    std::vector<Warning> warnings;
    return TextureLibrary(document, warnings).slot({{"index", 0}}, TexelKind::kData)->at({u, 0.5F}).x;
  };
  EXPECT_FLOAT_EQ(value(10497, 1.25F), 0.0F);
  EXPECT_FLOAT_EQ(value(10497, -0.25F), 1.0F);
  EXPECT_FLOAT_EQ(value(33071, 1.25F), 1.0F);
  EXPECT_FLOAT_EQ(value(33071, -7.0F), 0.0F);
  EXPECT_FLOAT_EQ(value(33648, 1.25F), 1.0F);
  EXPECT_FLOAT_EQ(value(33648, 1.75F), 0.0F);
  EXPECT_FLOAT_EQ(value(33648, -0.75F), 1.0F);
}

TEST(Textures, PointsBetweenTexelsAreBlended) {
  const TextureSlot slot = TextureFixture(2, 1, {0, 0, 0, 255, 255, 255, 255, 255}).slot();
  EXPECT_FLOAT_EQ(slot.at({0.5F, 0.5F}).x, 0.5F);
  EXPECT_FLOAT_EQ(slot.at({0.625F, 0.5F}).x, 0.75F);
}

TEST(Textures, TheTransformMovesScalesAndTurns) {
  TextureFixture fixture(2, 2, {10, 0, 0, 255, 20, 0, 0, 255, 30, 0, 0, 255, 40, 0, 0, 255});
  const auto red = [&](const Json& transform, glm::vec2 uv) {
    const Json info = {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}};
    return std::lround(fixture.slot(TexelKind::kData, info).at(uv).x * 255.0F);
  };
  EXPECT_EQ(red({{"offset", {0.5, 0.0}}}, {0.25F, 0.25F}), 20);
  EXPECT_EQ(red({{"scale", {3.0, 1.0}}}, {0.25F, 0.25F}), 20);
  // A quarter turn counter-clockwise, v down: (1, 0) goes to (0, -1).
  EXPECT_EQ(red({{"rotation", 1.57079632679}}, {0.75F, 0.25F}), 10);
  EXPECT_EQ(red({{"rotation", 1.57079632679}}, {0.25F, 0.25F}), 30);
  const Json info = {{"index", 0}, {"texCoord", 1}, {"extensions", {{"KHR_texture_transform", {{"texCoord", 2}}}}}};
  EXPECT_EQ(fixture.slot(TexelKind::kData, info).texcoord, 2);
}

TEST(Textures, WildCoordinatesAreHarmless) {
  const auto rgba = noise(16, 16, 5);
  const TextureSlot slot = TextureFixture(16, 16, rgba).slot();
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (const float wild : {nan, infinity, -infinity, 1e30F, -1e30F, 1e6F, -999999.0F}) {
    for (const Triangle& uv :
         {Triangle{{{wild, 0}, {0, 1}, {1, 1}}}, Triangle{{{wild, wild}, {wild, wild}, {wild, wild}}}}) {
      EXPECT_TRUE(std::isfinite(slot.mean(uv).x)) << wild;
      EXPECT_TRUE(std::isfinite(slot.at(uv[0]).x)) << wild;
    }
  }
  EXPECT_TRUE(std::isfinite(slot.mean({{{0.5F, 0.5F}, {0.5F, 0.5F}, {0.5F, 0.5F}}}).x)) << "a triangle without area";
}

TEST(Textures, AnEdgeThatRisesByADenormalNumberCoversNothing) {
  const TextureSlot slot = TextureFixture(16, 16, noise(16, 16, 5)).slot();
  const float denormal = std::numeric_limits<float>::denorm_min();
  EXPECT_NEAR(slot.mean({{{0.1F, 0}, {0.9F, 4.0F * denormal}, {0.5F, 1}}}).x,
              slot.mean({{{0.1F, 0}, {0.9F, 0}, {0.5F, 1}}}).x, 1e-6F);
}

TEST(Textures, RandomTrianglesStayWithinTheTexels) {
  const TextureSlot slot = TextureFixture(37, 21, noise(37, 21, 9)).slot();
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    const float size = std::exp2(std::uniform_real_distribution<float>(-12.0F, 6.0F)(random));
    std::uniform_real_distribution<float> place(-size, size);
    const glm::vec2 at(place(random) * 8, place(random) * 8);
    Triangle uv;
    for (glm::vec2& corner : uv) corner = at + glm::vec2(place(random), place(random));
    const glm::vec4 mean = slot.mean(uv);
    ASSERT_GE(mean.y, -1e-5F);
    ASSERT_LE(mean.y, 1.0F + 1e-5F);
    ASSERT_NEAR(mean.w, 1.0F, 1e-4F);
  }
}

TEST(Textures, WhatCannotBeReadIsNamed) {
  GltfBuilder builder;
  const std::size_t view = builder.add_buffer_view(std::vector<std::uint8_t>{1, 2, 3, 4});
  builder.json["images"] = Json::array({Json{{"bufferView", view}}});
  builder.json["textures"] = Json::array({Json{{"source", 0}}, Json::object()});
  const Document document = builder.document();
  std::vector<Warning> warnings;
  TextureLibrary library(document, warnings);
  EXPECT_EQ(library.slot({{"index", 0}}, TexelKind::kColor).error().text(), "images[0]: is neither PNG, JPEG nor WebP");
  EXPECT_EQ(library.slot({{"index", 1}}, TexelKind::kColor).error().text(), "textures[1]: has no image");
}

/// A texture with a KTX2 image, and a plain one of one red texel if `has_plain`.
GltfBuilder ktx2_texture(bool has_plain) {
  GltfBuilder builder;
  builder.add_texture(1, 1, {255, 0, 0, 255});
  const std::vector<std::uint8_t> ktx2 = {0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb};
  const std::size_t view = builder.add_buffer_view(ktx2);
  builder.json["images"].push_back({{"bufferView", view}, {"mimeType", "image/ktx2"}});
  Json& texture = builder.json["textures"][0];
  texture["extensions"]["KHR_texture_basisu"]["source"] = 1;
  if (!has_plain) texture.erase("source");
  return builder;
}

TEST(Textures, APlainImageStandsInForOneThatCannotBeDecoded) {
  const Document document = ktx2_texture(true).document();
  std::vector<Warning> warnings;
  TextureLibrary library(document, warnings);
  for (int use = 0; use < 2; ++use) {
    const auto slot = library.slot({{"index", 0}}, TexelKind::kColor);
    ASSERT_TRUE(slot) << slot.error().text();
    EXPECT_EQ(slot->at({0, 0}), glm::vec4(1, 0, 0, 1));
  }
  ASSERT_EQ(warnings.size(), 1U) << "once for each texture";
  EXPECT_EQ(warnings[0].code, "texture-fallback");
  EXPECT_EQ(warnings[0].place, "textures[0]");
}

TEST(Textures, WithoutAPlainImageATextureThatCannotBeDecodedIsWhite) {
  const Document document = ktx2_texture(false).document();
  std::vector<Warning> warnings;
  TextureLibrary library(document, warnings);
  const auto slot = library.slot({{"index", 0}}, TexelKind::kColor);
  ASSERT_TRUE(slot) << slot.error().text();
  EXPECT_EQ(slot->at({0, 0}), glm::vec4(1.0F));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].code, "texture-unread");
  EXPECT_EQ(warnings[0].place, "textures[0]");
}

TEST(Textures, AnImageIsDecodedOnceForEachKind) {
  GltfBuilder builder;
  builder.add_texture(1, 1, {1, 2, 3, 4});
  const Document document = builder.document();
  std::vector<Warning> warnings;
  TextureLibrary library(document, warnings);
  const auto first = library.slot({{"index", 0}}, TexelKind::kColor),
             second = library.slot({{"index", 0}}, TexelKind::kColor);
  EXPECT_EQ(first->image, second->image);
  EXPECT_NE(first->image, library.slot({{"index", 0}}, TexelKind::kData)->image);
}

}  // namespace
}  // namespace gltf_radiosity
