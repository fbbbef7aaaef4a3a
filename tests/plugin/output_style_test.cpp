#include "plugin/output_style.h"

#include <gtest/gtest.h>

namespace gltf_radiosity {
namespace {

OutputStyle style_of(Engine engine, std::optional<ColorType> type = std::nullopt,
                     std::optional<bool> scale = std::nullopt) {
  Options options;
  options.engine = engine;
  options.color_type = type;
  options.scale_to_factor = scale;
  return output_style(options);
}

constexpr Engine kEngines[] = {Engine::kAny,   Engine::kThree,  Engine::kBabylon, Engine::kGodot,
                               Engine::kUnity, Engine::kUnreal, Engine::kBlender};

TEST(OutputStyle, FloatsAreRightInAnyEngine) {
  EXPECT_EQ(style_of(Engine::kAny).color_type, ColorType::kFloat);
  EXPECT_FALSE(style_of(Engine::kAny).scale_to_factor);
}

TEST(OutputStyle, EnginesThatStoreEightBitsGetTheWholeRange) {
  for (const Engine engine : {Engine::kGodot, Engine::kUnreal, Engine::kBlender}) {
    EXPECT_TRUE(style_of(engine).scale_to_factor);
  }
  for (const Engine engine : {Engine::kThree, Engine::kBabylon, Engine::kUnity}) {
    EXPECT_FALSE(style_of(engine).scale_to_factor);
    EXPECT_EQ(style_of(engine).color_type, ColorType::kU16);
  }
  EXPECT_EQ(style_of(Engine::kGodot).color_type, ColorType::kU8);
}

TEST(OutputStyle, WhatIsAskedForWins) {
  for (const Engine engine : kEngines) {
    EXPECT_EQ(style_of(engine, ColorType::kFloat).color_type, ColorType::kFloat);
    EXPECT_FALSE(style_of(engine, {}, false).scale_to_factor);
    EXPECT_TRUE(style_of(engine, {}, true).scale_to_factor);
  }
}

TEST(OutputStyle, MeshoptTakesIntegers) {
  Options options;
  options.meshopt = true;
  EXPECT_EQ(output_style(options).color_type, ColorType::kU16);
  options.engine = Engine::kGodot;
  EXPECT_EQ(output_style(options).color_type, ColorType::kU8);
  options.color_type = ColorType::kFloat;
  EXPECT_EQ(output_style(options).color_type, ColorType::kFloat);
}

TEST(OutputStyle, CompressionThatAnEngineCannotReadIsWarnedAbout) {
  Options options;
  options.draco_bits = 16;
  EXPECT_FALSE(unreadable_compression(options));
  options.engine = Engine::kBlender;
  EXPECT_FALSE(unreadable_compression(options));
  options.engine = Engine::kGodot;
  EXPECT_TRUE(unreadable_compression(options));
  options.draco_bits = 0;
  EXPECT_FALSE(unreadable_compression(options));
}

}  // namespace
}  // namespace gltf_radiosity
