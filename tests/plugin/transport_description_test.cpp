#include "plugin/transport_description.h"

#include <gtest/gtest.h>

namespace gltf_radiosity {
namespace {

using radiosity::Rgb;

TransportDescription some() {
  TransportDescription some;
  some.sources = {{LightSource::Kind::kMaterial, "lamp", {"left"}, 3, Rgb(0.1F, 0.2F, 0.3F)}};
  some.materials = {{"lamp", 3, Rgb(0.7F), 0, false}, {"default material", std::nullopt, Rgb(1), std::nullopt, true}};
  some.material_of_surface = {1, 0};
  some.primitives = {{4, 5, 1, Rgb(0.9F), 0, 7}};
  some.exposure = 0.3;
  some.geometry = 0xfedcba9876543210U;
  some.scene = 2;
  some.radiance_semantic = "_LIGHT";
  some.parts = radiosity::LightParts::kIndirect;
  some.color_type = ColorType::kU8;
  some.draco_bits = 14;
  return some;
}

TEST(TransportDescription, IsReadAsItWasWritten) {
  const std::string text = to_text(some());
  const Result<TransportDescription> read = read_description(text);
  ASSERT_TRUE(read);
  EXPECT_EQ(to_text(*read), text);
  EXPECT_EQ(read->sources[0].strength, Rgb(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(read->sources[0].nodes, std::vector<std::string>{"left"});
  EXPECT_EQ(read->materials[0].shines, 0U);
  EXPECT_EQ(read->geometry, 0xfedcba9876543210U);
  EXPECT_EQ(read->scene, 2U);
}

TEST(TransportDescription, IsRefusedWhereSomethingIsMissingOrLeadsNowhere) {
  EXPECT_FALSE(read_description("{}"));
  EXPECT_FALSE(read_description("no JSON"));
  TransportDescription wrong = some();
  wrong.materials[0].shines = 1;
  EXPECT_FALSE(read_description(to_text(wrong)));
  wrong = some();
  wrong.material_of_surface = {2};
  EXPECT_FALSE(read_description(to_text(wrong)));
  wrong = some();
  wrong.primitives[0].material = 2;
  EXPECT_FALSE(read_description(to_text(wrong)));
}

}  // namespace
}  // namespace gltf_radiosity
