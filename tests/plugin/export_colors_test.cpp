#include "plugin/export_colors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "core/photometry.h"
#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

using radiosity::kPi;
constexpr float kTexelTolerance = 2e-3F;  // 8-bit sRGB texels

/// A unit square of one material under 2 pi lx: white shows 2 cd/m2.
struct Square {
  Json material = Json::object();
  std::vector<glm::vec4> old_colors;
  Options options;
  int levels = 1;

  GltfBuilder builder;

  std::size_t add_texture(std::uint8_t red, std::uint8_t green, std::uint8_t blue, std::uint8_t alpha = 255) {
    return builder.add_texture(1, 1, {red, green, blue, alpha});
  }

  VertexColors colors() {
    PrimitiveParts parts = unit_square();
    parts.colors = old_colors;
    parts.material = builder.add_material(material);
    builder.add_node(builder.add_mesh(parts));
    const HandBake hand = bake_by_hand(builder, levels, radiosity::Rgb(2.0F * kPi), options);
    const auto refined = split_by_instance(hand.bake.mesh, hand.scene);
    return vertex_colors(hand.scene, hand.bake, refined)[0];
  }
};

void expect_everywhere(const VertexColors& colors, const glm::vec4& expected) {
  ASSERT_FALSE(colors.unexposed.empty());
  for (const glm::vec4& color : colors.unexposed) {
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(color[c], expected[c], kTexelTolerance) << "component " << c;
  }
}

TEST(ExportColors, WithoutATextureTheReflectedLightIsShown) {
  Square square;
  square.material["pbrMetallicRoughness"] = {{"baseColorFactor", {0.5, 0.25, 0.125, 1.0}}};
  expect_everywhere(square.colors(), {1.0F, 0.5F, 0.25F, 1.0F});
}

TEST(ExportColors, WhatIsReflectedAlikeEverywhereIsNoted) {
  Square square;
  square.material["pbrMetallicRoughness"] = {{"baseColorFactor", {0.5, 0.25, 0.1, 1.0}}};
  Json primitive = Json::object();
  note_reflectance(square.colors(), primitive);
  EXPECT_EQ(primitive, Json::parse(R"({"extras": {"radiosity": {"reflectance": [0.5, 0.25, 0.1]}}})"));
}

TEST(ExportColors, WhatIsReflectedDifferentlyHereAndThereIsNotNoted) {
  Square square;
  square.old_colors = {glm::vec4(1.0F), glm::vec4(1.0F), glm::vec4(0.5F), glm::vec4(1.0F)};
  Json primitive = Json::object();
  note_reflectance(square.colors(), primitive);
  EXPECT_EQ(primitive, Json::object());
}

TEST(ExportColors, WhatEmitsIsNotedAsSuch) {
  Square square;
  square.material["emissiveFactor"] = {0.0, 0.5, 0.0};
  Json primitive = {{"extras", "a word"}};
  note_reflectance(square.colors(), primitive);
  EXPECT_EQ(primitive, Json::parse(R"({"extras": {"original": "a word",
                                                  "radiosity": {"reflectance": [1.0, 1.0, 1.0], "emits": true}}})"));
}

TEST(ExportColors, EveryVertexHasAColour) {
  Square square;
  square.levels = 2;
  EXPECT_EQ(square.colors().unexposed.size(), 25U);
}

TEST(ExportColors, WithATextureItIsLeftToTheTexture) {
  Square square;
  const std::size_t grey = square.add_texture(128, 128, 128);
  square.material["pbrMetallicRoughness"] = {{"baseColorTexture", {{"index", grey}}},
                                             {"baseColorFactor", {0.5, 0.25, 0.125, 1.0}}};
  expect_everywhere(square.colors(), {1.0F, 0.5F, 0.25F, 1.0F});
}

TEST(ExportColors, OldColoursMultiplyTheReflectance) {
  Square square;
  square.old_colors = {{1, 1, 1, 1}, {1, 1, 1, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}};
  const VertexColors colors = square.colors();
  EXPECT_NEAR(colors.unexposed[0].x, 2.0F, kTexelTolerance);
  EXPECT_NEAR(colors.unexposed[2].x, 0.0F, kTexelTolerance);
  EXPECT_NEAR(colors.unexposed[1].y, 2.0F, kTexelTolerance);
  float sum = 0.0F;  // of the nine vertices three are white, three in between, three black
  for (const glm::vec4& color : colors.unexposed) sum += color.x;
  EXPECT_NEAR(sum, 9.0F, 9 * kTexelTolerance);
}

TEST(ExportColors, EmissionIsAdded) {
  Square square;
  square.material = {{"emissiveFactor", {0.5, 0.25, 0.0}},
                     {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4.0}}}}}};
  square.builder.json["extensionsUsed"] = Json::array({"KHR_materials_emissive_strength"});
  expect_everywhere(square.colors(), {4.0F, 3.0F, 2.0F, 1.0F});
}

TEST(ExportColors, EmissionIsDividedByTheTextureThatWillMultiplyIt) {
  Square square;
  const std::size_t grey = square.add_texture(188, 188, 188);  // 0.503 linear
  square.material = {{"emissiveFactor", {1.0, 0.0, 0.0}},
                     {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", grey}}}}}};
  const float texture = std::pow((188.0F / 255.0F + 0.055F) / 1.055F, 2.4F);
  expect_everywhere(square.colors(), {2.0F + 1.0F / texture, 2.0F, 2.0F, 1.0F});
}

TEST(ExportColors, ABlackTextureDoesNotMakeEmissionInfinite) {
  Square square;
  const std::size_t black = square.add_texture(0, 0, 0);
  square.material = {{"emissiveFactor", {1.0, 1.0, 1.0}},
                     {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", black}}}}}};
  expect_everywhere(square.colors(), {66.0F, 66.0F, 66.0F, 1.0F});
}

TEST(ExportColors, EmissiveTexturesAreAveraged) {
  Square square;
  const std::size_t red = square.add_texture(255, 0, 0);
  square.material = {{"emissiveFactor", {1.0, 1.0, 1.0}}, {"emissiveTexture", {{"index", red}}}};
  expect_everywhere(square.colors(), {3.0F, 2.0F, 2.0F, 1.0F});
}

TEST(ExportColors, AlphaIsKeptWhereItMatters) {
  for (const char* mode : {"BLEND", "MASK"}) {
    Square square;
    square.old_colors.assign(4, {1.0F, 1.0F, 1.0F, 0.5F});
    square.material["alphaMode"] = mode;
    expect_everywhere(square.colors(), {2.0F, 2.0F, 2.0F, 0.5F});
  }
  Square opaque;
  opaque.old_colors.assign(4, {1.0F, 1.0F, 1.0F, 0.5F});
  expect_everywhere(opaque.colors(), {2.0F, 2.0F, 2.0F, 1.0F});
}

TEST(ExportColors, BlackMetalsShowTheirDiffuseShare) {
  Square square;
  square.options.metals = Metals::kBlack;
  square.material["pbrMetallicRoughness"] = {{"metallicFactor", 0.75}};
  expect_everywhere(square.colors(), {0.5F, 0.5F, 0.5F, 1.0F});
  Square textured;
  textured.options.metals = Metals::kBlack;
  const std::size_t half_blue = textured.add_texture(0, 0, 128);
  textured.material["pbrMetallicRoughness"] = {{"metallicRoughnessTexture", {{"index", half_blue}}}};
  const float share = 2.0F * (1.0F - 128.0F / 255.0F);
  expect_everywhere(textured.colors(), {share, share, share, 1.0F});
}

TEST(ExportColors, MetalsAreDiffuseByDefault) {
  Square square;
  square.material["pbrMetallicRoughness"] = {{"metallicFactor", 1.0}};
  expect_everywhere(square.colors(), {2.0F, 2.0F, 2.0F, 1.0F});
}

TEST(ExportColors, SamplesStandForTheWholeArea) {
  Square square;
  square.levels = 3;
  float area = 0.0F;
  for (const auto& sample : square.colors().samples) {
    EXPECT_FALSE(sample.lamp);
    area += sample.area;
  }
  EXPECT_NEAR(area, 1.0F, 1e-5F);
}

TEST(ExportColors, WhatEmitsIsALamp) {
  Square square;
  square.material["emissiveFactor"] = {0.0, 0.0, 0.1};
  for (const auto& sample : square.colors().samples) EXPECT_TRUE(sample.lamp);
}

TEST(ExportColors, WhatDoesNotReceiveHasNoColours) {
  Square square;
  square.material["extensions"]["KHR_materials_unlit"] = Json::object();
  square.builder.json["extensionsUsed"] = Json::array({"KHR_materials_unlit"});
  PrimitiveParts lit = unit_square();
  square.builder.add_node(square.builder.add_mesh(lit));  // something to bake
  PrimitiveParts parts = unit_square();
  parts.material = square.builder.add_material(square.material);
  square.builder.add_node(square.builder.add_mesh(parts));
  const HandBake hand = bake_by_hand(square.builder, 0, radiosity::Rgb(1.0F));
  const auto refined = split_by_instance(hand.bake.mesh, hand.scene);
  const auto colors = vertex_colors(hand.scene, hand.bake, refined);
  ASSERT_EQ(colors.size(), 2U);
  EXPECT_EQ(colors[0].unexposed.size(), 4U);
  EXPECT_TRUE(colors[1].unexposed.empty());
}

// The accessor.

std::vector<float> stored(const VertexColors& colors, float k, ColorType type, Json* accessor = nullptr) {
  Document document;
  BufferBuilder added;
  const std::size_t index = export_color_accessor(document, added, colors, {}, radiosity::Rgb(k), type);
  document.buffers.push_back(added.bytes());
  if (accessor != nullptr) *accessor = document.json["accessors"][index];
  return as_floats(read_accessor(document, index));
}

const VertexColors kTwo = {
    {{0.5F, 4.0F, 0.25F, 0.75F}, {-1.0F, std::numeric_limits<float>::quiet_NaN(), 1.0F, 2.0F}}, {}, {1, 2}};

TEST(ExportColors, ColoursAreExposedAndClamped) {
  const std::vector<float> expected = {0.25F, 1.0F, 0.125F, 0.75F, 0.0F, 0.0F, 0.5F, 1.0F};
  EXPECT_EQ(stored(kTwo, 0.5F, ColorType::kFloat), expected);
}

TEST(ExportColors, EveryTypeIsFourLinearComponents) {
  Json accessor;
  stored(kTwo, 1.0F, ColorType::kFloat, &accessor);
  EXPECT_EQ(accessor["type"], "VEC4");
  EXPECT_EQ(accessor["componentType"], 5126);
  EXPECT_FALSE(accessor.contains("normalized"));

  const std::vector<float> u16 = stored(kTwo, 1.0F, ColorType::kU16, &accessor);
  EXPECT_EQ(accessor["componentType"], 5123);
  EXPECT_EQ(accessor["normalized"], true);
  EXPECT_NEAR(u16[0], 0.5F, 0.5F / 65535.0F);

  const std::vector<float> u8 = stored(kTwo, 1.0F, ColorType::kU8, &accessor);
  EXPECT_EQ(accessor["componentType"], 5121);
  EXPECT_NEAR(u8[0], 0.5F, 1.01F / 255.0F);
  EXPECT_EQ(u8[1], 1.0F);
}

TEST(ExportColors, EightBitsAreDitheredAboutTheirValue) {
  constexpr float kBetween = 10.25F / 255.0F, kOnAStep = 20.0F / 255.0F;
  VertexColors colors;
  for (std::uint32_t i = 0; i < 4000; ++i) {
    colors.unexposed.emplace_back(kBetween, kOnAStep, 0.0F, 1.0F);
    colors.places.push_back(i);
  }
  const std::vector<float> shown = stored(colors, 1.0F, ColorType::kU8);
  double sum = 0.0;
  for (std::size_t v = 0; v < 4000; ++v) {
    sum += static_cast<double>(shown[4 * v]);
    EXPECT_LT(std::abs(shown[4 * v] - kBetween), 1.0F / 255.0F);
    EXPECT_NEAR(shown[4 * v + 1], kOnAStep, 1e-6F) << "what lies on a step stays";
    EXPECT_EQ(shown[4 * v + 2], 0.0F);
    EXPECT_EQ(shown[4 * v + 3], 1.0F);
  }
  EXPECT_NEAR(sum / 4000.0, static_cast<double>(kBetween), 0.03 / 255.0);
}

TEST(ExportColors, VerticesAtOnePlaceAreDitheredAlike) {
  Square square;
  square.levels = 2;
  const VertexColors colors = square.colors();
  std::set<std::uint32_t> places(colors.places.begin(), colors.places.end());
  EXPECT_EQ(places.size(), 25U) << "25 positions";
  VertexColors seam;
  for (int i = 0; i < 50; ++i) {
    seam.unexposed.emplace_back(0.3F, 0.6F, 0.1F, 1.0F);
    seam.places.push_back(colors.places[3]);
  }
  const std::vector<float> shown = stored(seam, 1.0F, ColorType::kU8);
  for (std::size_t v = 0; v < 50; ++v) EXPECT_EQ(shown[4 * v], shown[0]);
}

TEST(ExportColors, TheBrightestOfEachBandIsFound) {
  const VertexColors colors = {{{0.5F, 0.0F, 4.0F, 1.0F}, {0.25F, 0.0F, 1.0F, 1.0F}}, {}, {}};
  EXPECT_EQ(brightest(colors, {}, 0.5F), radiosity::Rgb(0.25F, 1.0F, 1.0F));
  EXPECT_EQ(brightest(colors, std::vector<std::uint32_t>{1}, 0.5F), radiosity::Rgb(0.125F, 1.0F, 0.5F))
      << "of those that are written";
}

TEST(ExportColors, TheRadianceIsNotClamped) {
  Document document;
  BufferBuilder added;
  export_radiance_accessor(document, added, {{{0.5F, 4.0F, 8.0F, 1.0F}}, {}, {}}, {}, 2.0F);
  document.buffers.push_back(added.bytes());
  EXPECT_EQ(as_floats(read_accessor(document, 0)), (std::vector<float>{1.0F, 8.0F, 16.0F}));
  EXPECT_EQ(document.json["accessors"][0]["type"], "VEC3");
  Options options;
  for (const char* name : {"LIGHT", "_LIGHT"}) {
    options.radiance_attribute = name;
    EXPECT_EQ(radiance_semantic(options), "_LIGHT");
  }
}

}  // namespace
}  // namespace gltf_radiosity
