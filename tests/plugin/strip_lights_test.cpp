#include "plugin/strip_lights.h"

#include <gtest/gtest.h>

#include "tests/plugin/gltf_builder.h"

namespace gltf_radiosity {
namespace {

Document stripped(const GltfBuilder& builder) {
  Document document = builder.document();
  strip_lights(document);
  return document;
}

TEST(StripLights, PunctualLightsLeaveAndTheirNodesStay) {
  GltfBuilder builder;
  builder.add_light({{"type", "point"}}, {{"name", "lamp"}});
  const Document document = stripped(builder);
  EXPECT_FALSE(document.json.contains("extensions"));
  EXPECT_FALSE(document.json.contains("extensionsUsed"));
  EXPECT_EQ(document.json["nodes"], Json::parse(R"([{"name": "lamp"}])"));
}

TEST(StripLights, OtherExtensionsStay) {
  GltfBuilder builder;
  builder.add_light({{"type", "point"}}, {{"extensions", {{"EXAMPLE_tag", {{"name", "x"}}}}}});
  builder.json["extensions"]["EXAMPLE_tag"] = {{"name", "y"}};
  builder.json["extensionsUsed"].push_back("EXAMPLE_tag");
  const Document document = stripped(builder);
  EXPECT_EQ(document.json["extensionsUsed"], Json::array({"EXAMPLE_tag"}));
  EXPECT_EQ(document.json["nodes"][0]["extensions"].size(), 1U);
  EXPECT_EQ(document.json["extensions"].size(), 1U);
}

TEST(StripLights, ImagesThatOnlyASkyUsedLeaveWithTheirData) {
  GltfBuilder builder;
  const std::size_t sky = builder.add_texture(1, 1, {9, 9, 9, 255});   // its image is the first
  const std::size_t wall = builder.add_texture(1, 1, {1, 2, 3, 255});  // and this the second
  builder.json["textures"].erase(sky);
  builder.add_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", wall - 1}}}}}});
  builder.add_node(std::nullopt);
  builder.json["extensions"]["EXT_lights_image_based"]["lights"] = {{{"specularImages", {{0, 0, 0, 0, 0, 0}}}}};
  builder.json["scenes"][0]["extensions"]["EXT_lights_image_based"] = {{"light", 0}};
  const Document before = builder.document(), after = stripped(builder);
  ASSERT_EQ(after.json["images"].size(), 1U);
  EXPECT_EQ(after.json["textures"][0]["source"], 0);
  EXPECT_FALSE(after.json["scenes"][0].contains("extensions"));
  EXPECT_LT(after.buffers[0].size(), before.buffers[0].size());
  const auto bytes = image_bytes(after, 0), expected = image_bytes(before, 1);
  ASSERT_TRUE(bytes && expected);
  EXPECT_EQ(*bytes, *expected);
}

TEST(StripLights, AnimationsOfLightsEnd) {
  GltfBuilder builder;
  builder.add_light({{"type", "point"}});
  const Json light = Json::parse(R"({"sampler": 0, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer":
      {"pointer": "/extensions/KHR_lights_punctual/lights/0/intensity"}}}})");
  const Json node = Json::parse(R"({"sampler": 0, "target": {"node": 0, "path": "translation"}})");
  builder.json["animations"] = {{{"channels", {light, node}}, {"samplers", Json::array()}},
                                {{"channels", {light}}, {"samplers", Json::array()}}};
  const Document document = stripped(builder);
  ASSERT_EQ(document.json["animations"].size(), 1U);
  EXPECT_EQ(document.json["animations"][0]["channels"], Json::array({node}));
}

}  // namespace
}  // namespace gltf_radiosity
