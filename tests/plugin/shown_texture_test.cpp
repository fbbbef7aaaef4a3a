#include "plugin/shown_texture.h"

#include <gtest/gtest.h>

#include "core/photometry.h"
#include "plugin/export_colors.h"
#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

using radiosity::kPi;
using radiosity::Rgb;

/// A unit square whose base colour is white with black, and whose emission is black with white, under 2 pi lx.
struct Screen {
  GltfBuilder builder;
  Json material = Json::object();

  explicit Screen(float emitted) {
    const std::vector<std::uint8_t> white_black = {255, 255, 255, 255, 0, 0, 0, 255};
    const std::vector<std::uint8_t> black_white = {0, 0, 0, 255, 255, 255, 255, 255};
    material = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", builder.add_texture(2, 1, white_black)}}}}},
                {"emissiveTexture", {{"index", builder.add_texture(2, 1, black_white)}}},
                {"emissiveFactor", {emitted, emitted, emitted}}};
  }

  HandBake baked(int levels = 0) {
    PrimitiveParts parts = unit_square();
    parts.material = builder.add_material(material);
    builder.add_node(builder.add_mesh(parts));
    return bake_by_hand(builder, levels, Rgb(2.0F * kPi));
  }

  TextureChoice choice(float white = 1000.0F) {
    const HandBake hand = baked();
    return choose_textures(hand.scene, hand.bake, split_by_instance(hand.bake.mesh, hand.scene), white);
  }
  ShownTexture shown(float white = 1000.0F) { return choice(white).shown.at(0); }
};

TEST(ShownTexture, IsThatOfTheBrighterLight) {
  EXPECT_EQ(Screen(10.0F).shown(), ShownTexture::kEmissive);
  EXPECT_EQ(Screen(0.1F).shown(), ShownTexture::kBaseColor);
}

TEST(ShownTexture, IsTheOnlyOneThereIs) {
  Screen lamp(0.1F);
  lamp.material.erase("pbrMetallicRoughness");
  lamp.material["emissiveFactor"] = {10.0, 10.0, 10.0};
  EXPECT_EQ(lamp.shown(), ShownTexture::kEmissive);
  Screen painted(10.0F);
  painted.material.erase("emissiveTexture");
  EXPECT_EQ(painted.shown(), ShownTexture::kBaseColor);
}

TEST(ShownTexture, IsThatOfTheBaseColourWhereALampIsWhiteAllTheSame) {
  Screen lamp(100.0F);
  lamp.material.erase("pbrMetallicRoughness");
  lamp.material["emissiveTexture"]["index"] = lamp.builder.add_texture(2, 1, {255, 255, 255, 255, 99, 99, 99, 255});
  EXPECT_EQ(lamp.shown(), ShownTexture::kEmissive);
  EXPECT_EQ(lamp.shown(1.0F), ShownTexture::kBaseColor);
}

// The mean of black and very bright texels is as white as a lamp that has no black ones.
TEST(ShownTexture, IsNotAveragedBeforeItIsCutOffAtWhite) {
  Screen panel(100.0F);
  panel.material.erase("pbrMetallicRoughness");
  std::vector<std::uint8_t> stripes;
  for (int column = 0; column < 64; ++column) {
    const std::uint8_t value = column % 8 == 2 || column % 8 == 3 ? 255 : 0;
    stripes.insert(stripes.end(), {value, value, value, 255});
  }
  panel.material["emissiveTexture"]["index"] = panel.builder.add_texture(64, 1, stripes);
  EXPECT_EQ(panel.shown(20.0F), ShownTexture::kEmissive) << "2 cd/m2 are reflected, 25 emitted on average";
}

TEST(ShownTexture, IsThatOfTheBaseColourWhereItHoldsTheAlpha) {
  for (const char* mode : {"BLEND", "MASK"}) {
    Screen screen(10.0F);
    screen.material["alphaMode"] = mode;
    EXPECT_EQ(screen.shown(), ShownTexture::kBaseColor) << mode;
  }
}

TEST(ShownTexture, IsThatOfTheBaseColourWhereBothAreTheSame) {
  Screen screen(10.0F);
  screen.material["emissiveTexture"] = screen.material["pbrMetallicRoughness"]["baseColorTexture"];
  EXPECT_EQ(screen.shown(), ShownTexture::kBaseColor);
}

TEST(ShownTexture, KnowsWhatIsWrongBecauseItIsOnlyOne) {
  // 2 cd/m2 are reflected everywhere, and 10 emitted by one half, which is a quarter of one triangle and three of the
  // other: there 18 and 12.7 are displayed instead of 12, and none instead of 2 elsewhere.
  Screen screen(10.0F);
  screen.material.erase("pbrMetallicRoughness");
  const double lit = 0.125 * 6.0 * 6.0 + 0.375 * (2.0 / 3.0) * (2.0 / 3.0), dark = 0.5 * 2.0 * 2.0;
  EXPECT_NEAR(screen.choice().squared_error, lit + dark, 1e-4);
  EXPECT_EQ(Screen(0.0F).choice().squared_error, 0.0);
}

// An emissive picture used to be as blurred as the vertices are apart: a window in a bathroom was a grey board.
TEST(ShownTexture, OfAScreenIsExact) {
  Screen screen(10.0F);
  screen.material.erase("pbrMetallicRoughness");
  const HandBake hand = screen.baked(2);
  const auto refined = split_by_instance(hand.bake.mesh, hand.scene);
  const std::vector<ShownTexture> textures = {ShownTexture::kEmissive};
  const VertexColors colors = vertex_colors(hand.scene, hand.bake, refined, {}, textures)[0];
  // The picture is half white where a vertex sees both halves, black on one side and white on the other.
  float least = 1e9F, most = 0.0F;
  for (const glm::vec4& color : colors.unexposed) {
    least = std::min(least, color.x);
    most = std::max(most, color.x);
  }
  EXPECT_NEAR(least, 10.0F + 2.0F, 0.1F) << "what reflects is added where the picture is white";
  EXPECT_NEAR(most, 10.0F + 2.0F * 64.0F, 0.1F) << "and as far as may be where it is black";
}

}  // namespace
}  // namespace gltf_radiosity
