#include "plugin/drop_unused.h"

#include <gtest/gtest.h>

#include "plugin/accessor_view.h"
#include "tests/plugin/gltf_builder.h"

namespace gltf_radiosity {
namespace {

/// A triangle, and before its data accessors that nothing refers to.
GltfBuilder with_unused(std::size_t count) {
  GltfBuilder builder;
  for (std::size_t i = 0; i < count; ++i) builder.add_accessor(std::vector<glm::vec3>(100, glm::vec3(1.0F)));
  PrimitiveParts triangle;
  triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.indices = {0, 1, 2};
  builder.add_node(builder.add_mesh(triangle));
  return builder;
}

Document dropped(const GltfBuilder& builder) {
  Document document = builder.document();
  drop_unused_data(document);
  return document;
}

std::vector<float> positions(const Document& document) {
  const Json& attributes = document.json["meshes"][0]["primitives"][0]["attributes"];
  return as_floats(read_accessor(document, attributes["POSITION"].get<std::size_t>()));
}

TEST(DropUnused, WhatNothingRefersToLeavesWithItsBytes) {
  const GltfBuilder small = with_unused(0), large = with_unused(2);
  const Document document = dropped(large);
  EXPECT_EQ(document.json["accessors"].size(), 2U);
  EXPECT_EQ(document.json["bufferViews"].size(), 2U);
  EXPECT_EQ(document.buffers[0].size(), dropped(small).buffers[0].size());
  EXPECT_EQ(document.json["buffers"][0]["byteLength"], document.buffers[0].size());
  EXPECT_EQ(positions(document), positions(large.document()));
}

TEST(DropUnused, WhatIsUsedKeepsItsValues) {
  const GltfBuilder builder = with_unused(0);
  const Document document = dropped(builder);
  EXPECT_EQ(document.json["accessors"], builder.document().json["accessors"]);
  EXPECT_EQ(positions(document), positions(builder.document()));
}

TEST(DropUnused, AnimationsSkinsImagesAndInstancesCount) {
  GltfBuilder builder = with_unused(5);
  builder.json["animations"] = {{{"samplers", {{{"input", 0}, {"output", 1}}}}, {"channels", Json::array()}}};
  builder.json["skins"] = {{{"inverseBindMatrices", 2}, {"joints", {0}}}};
  builder.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = {{"attributes", {{"TRANSLATION", 3}}}};
  builder.json["images"] = {{{"bufferView", 4}, {"mimeType", "image/png"}}};
  const Document document = dropped(builder);
  EXPECT_EQ(document.json["accessors"].size(), 4U + 2U);
  EXPECT_EQ(document.json["bufferViews"].size(), 5U + 2U);
  EXPECT_EQ(document.json["images"][0]["bufferView"], 4);
}

TEST(DropUnused, OverlappingViewsStayWhereTheyAreToEachOther) {
  GltfBuilder builder = with_unused(1);
  const Bytes bytes = {9, 1, 2, 3, 4, 5, 6, 7};
  const std::size_t view = builder.add_buffer_view(bytes);
  Json inner = builder.json["bufferViews"][view];
  inner["byteOffset"] = inner["byteOffset"].get<std::size_t>() + 3;
  inner["byteLength"] = 2;
  builder.json["bufferViews"].push_back(inner);
  builder.json["images"] = {{{"bufferView", view}}, {{"bufferView", view + 1}}};
  const Document document = dropped(builder);
  const Json& images = document.json["images"];
  const auto at = [&](std::size_t image) {
    return document.json["bufferViews"][images[image]["bufferView"].get<std::size_t>()]["byteOffset"]
        .get<std::size_t>();
  };
  EXPECT_EQ(document.buffers[0][at(0)], 9);
  EXPECT_EQ(document.buffers[0][at(1)], 3);
  EXPECT_EQ(at(1) - at(0), 3U);
}

TEST(DropUnused, SourcesThatAreNoImagesReferToNothing) {
  for (const Json& source : {Json("a name"), Json(99), Json(-1), Json::array({0})}) {
    GltfBuilder builder = with_unused(0);
    builder.add_texture(1, 1, {255, 255, 255, 255});
    builder.add_texture(1, 1, {0, 0, 0, 255});
    builder.json["textures"][0]["extensions"]["EXT_texture_by_others"]["source"] = source;
    Document document = builder.document();
    drop_images(document, {0, 1});
    EXPECT_EQ(document.json["images"].size(), 2U) << source;
    document.json["textures"].erase(1);
    drop_images(document, {0, 1});
    EXPECT_EQ(document.json["images"].size(), 1U) << source;
  }
}

TEST(DropUnused, NumbersThatAnUnknownExtensionMayMeanStay) {
  GltfBuilder builder = with_unused(3);
  builder.json["meshes"][0]["extensions"]["EXAMPLE_tables"] = {{"columns", {{{"values", 1}}}}};
  const Document document = dropped(builder);
  EXPECT_EQ(document.json["accessors"].size(), 5U);
  EXPECT_EQ(document.json["accessors"][1], builder.document().json["accessors"][1]);
  EXPECT_EQ(as_floats(read_accessor(document, 1)).size(), 300U);
  EXPECT_FALSE(document.json["accessors"][0].contains("bufferView"));
  EXPECT_LT(document.buffers[0].size(), 2000U) << "two of the three are gone";
  EXPECT_EQ(positions(document), positions(builder.document()));
}

}  // namespace
}  // namespace gltf_radiosity
