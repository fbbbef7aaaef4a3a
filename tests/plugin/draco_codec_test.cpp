#include "plugin/draco_codec.h"

#include <draco/attributes/geometry_attribute.h>
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <gtest/gtest.h>

#include "plugin/accessor_view.h"
#include "tests/plugin/gltf_builder.h"

namespace gltf_radiosity {
namespace {

constexpr std::uint32_t kPositionId = 7, kColorId = 3;

/// A strip of `count` triangles with positions and normalised 8-bit colours, sequentially encoded: the order is kept.
Bytes encode_strip(std::uint32_t count) {
  draco::Mesh mesh;
  mesh.set_num_points(count + 2);
  draco::GeometryAttribute position, color;
  position.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
  color.Init(draco::GeometryAttribute::COLOR, nullptr, 3, draco::DT_UINT8, true, 3, 0);
  const int position_index = mesh.AddAttribute(position, true, count + 2);
  const int color_index = mesh.AddAttribute(color, true, count + 2);
  for (std::uint32_t i = 0; i < count + 2; ++i) {
    const float xyz[3] = {static_cast<float>(i), static_cast<float>(i % 2), 0.5F};
    const auto value = static_cast<std::uint8_t>(i);
    const std::uint8_t rgb[3] = {value, 100, 255};
    mesh.attribute(position_index)->SetAttributeValue(draco::AttributeValueIndex(i), xyz);
    mesh.attribute(color_index)->SetAttributeValue(draco::AttributeValueIndex(i), rgb);
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    mesh.AddFace({draco::PointIndex(i), draco::PointIndex(i + 1 + i % 2), draco::PointIndex(i + 2 - i % 2)});
  }
  mesh.attribute(position_index)->set_unique_id(kPositionId);
  mesh.attribute(color_index)->set_unique_id(kColorId);

  draco::ExpertEncoder encoder(mesh);
  encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeToBuffer(&buffer).ok());
  return {buffer.data(), buffer.data() + buffer.size()};
}

/// A glTF whose primitives are compressed strips of these lengths, all with the same accessors.
GltfBuilder compressed(const std::vector<std::uint32_t>& counts) {
  GltfBuilder builder;
  builder.json["accessors"] = {
      {{"componentType", 5126}, {"count", counts[0] + 2}, {"type", "VEC3"}},
      {{"componentType", 5121}, {"count", counts[0] + 2}, {"type", "VEC3"}, {"normalized", true}},
      {{"componentType", 5123}, {"count", counts[0] * 3}, {"type", "SCALAR"}}};
  Json primitives = Json::array();
  for (const std::uint32_t count : counts) {
    const std::size_t view = builder.add_buffer_view(encode_strip(count));
    Json primitive = {{"attributes", {{"POSITION", 0}, {"COLOR_0", 1}}}, {"indices", 2}};
    primitive["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", view}, {"attributes", {{"POSITION", kPositionId}, {"COLOR_0", kColorId}}}};
    primitives.push_back(primitive);
  }
  builder.add_mesh(primitives);
  builder.json["extensionsUsed"] = {"KHR_draco_mesh_compression", "KHR_materials_unlit"};
  builder.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return builder;
}

std::string verdict(const GltfBuilder& builder) {
  const auto document = read_document(builder.glb(), {});
  return document ? "fine" : document.error().text();
}

TEST(DracoCodec, GivesBackWhatWasEncoded) {
  const auto document = read_document(compressed({4}).glb(), {});
  ASSERT_TRUE(document) << document.error().text();
  const std::vector<float> positions = as_floats(read_accessor(*document, 0));
  ASSERT_EQ(positions.size(), 18U);
  EXPECT_EQ(positions[15], 5.0F);
  EXPECT_EQ(positions[16], 1.0F);
  EXPECT_EQ(positions[17], 0.5F);
  const RawAccessor colors = read_accessor(*document, 1);
  EXPECT_EQ(Bytes(colors.bytes.begin(), colors.bytes.begin() + 6), (Bytes{0, 100, 255, 1, 100, 255}));
  EXPECT_EQ(as_indices(read_accessor(*document, 2)), (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4}));
}

TEST(DracoCodec, BoundsAreThoseOfTheDecodedValues) {
  GltfBuilder builder = compressed({4});
  builder.json["accessors"][0]["min"] = {-0.01, 0.0, 0.49};
  builder.json["accessors"][0]["max"] = {5.01, 1.0, 0.51};
  const auto document = read_document(builder.glb(), {});
  ASSERT_TRUE(document) << document.error().text();
  const Json& position = document->json["accessors"][0];
  EXPECT_EQ(position["min"], Json({0.0, 0.0, 0.5}));
  EXPECT_EQ(position["max"], Json({5.0, 1.0, 0.5}));
  EXPECT_FALSE(document->json["accessors"][1].contains("min"));
}

TEST(DracoCodec, LeavesNoTraceOfTheExtension) {
  const auto document = read_document(compressed({2}).glb(), {});
  ASSERT_TRUE(document) << document.error().text();
  EXPECT_EQ(document->json["meshes"].dump().find("draco"), std::string::npos);
  EXPECT_EQ(document->json["extensionsUsed"], Json::array({"KHR_materials_unlit"}));
  EXPECT_FALSE(document->json.contains("extensionsRequired"));
  EXPECT_EQ(document->json["buffers"].size(), document->buffers.size());
}

TEST(DracoCodec, VertexDataStaysAlignedToFourBytes) {
  const auto document = read_document(compressed({3}).glb(), {});
  ASSERT_TRUE(document) << document.error().text();
  const Json& view = document->json["bufferViews"][document->json["accessors"][1]["bufferView"].get<std::size_t>()];
  EXPECT_EQ(view["byteStride"], 4) << "three bytes of colour and one of padding";
  EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0U);
}

TEST(DracoCodec, AccessorsSharedByDifferentBlobsAreCloned) {
  const auto document = read_document(compressed({3, 3}).glb(), {});
  ASSERT_TRUE(document) << document.error().text();
  const Json& primitives = document->json["meshes"][0]["primitives"];
  EXPECT_NE(primitives[0]["indices"], primitives[1]["indices"]);
  const auto second = primitives[1]["attributes"]["POSITION"].get<std::size_t>();
  EXPECT_EQ(as_floats(read_accessor(*document, 0)), as_floats(read_accessor(*document, second)));
}

TEST(DracoCodec, OneBlobSharedByPrimitivesIsDecodedOnce) {
  GltfBuilder builder = compressed({3});
  builder.add_mesh(builder.json["meshes"][0]["primitives"]);
  const auto document = read_document(builder.glb(), {});
  ASSERT_TRUE(document) << document.error().text();
  EXPECT_EQ(document->json["accessors"].size(), 3U);
  EXPECT_EQ(document->json["meshes"][0]["primitives"], document->json["meshes"][1]["primitives"]);
}

TEST(DracoCodec, CountsMustAgreeWithTheAccessors) {
  GltfBuilder builder = compressed({3});
  builder.json["accessors"][0]["count"] = builder.json["accessors"][1]["count"] = 4;
  EXPECT_EQ(verdict(builder), "meshes[0].primitives[0]: Draco holds 5 vertices where accessors[0] says 4");
  builder = compressed({3});
  builder.json["accessors"][2]["count"] = 12;
  EXPECT_EQ(verdict(builder), "meshes[0].primitives[0]: Draco holds 9 indices where the accessor says 12");
  builder = compressed({3});
  builder.json["accessors"][0]["type"] = "VEC2";
  EXPECT_NE(verdict(builder), "fine");
}

// Found by fuzz_draco: 525 bytes say that two thousand million orientations of triangles follow, and Draco reads on
// beyond the end of the blob, for seconds.
TEST(DracoCodec, ABlobThatSaysItHoldsMoreOrientationsThanItHasBytesIsRefused) {
  const std::string blob =
      "RFJBQ08CAgEBAAAAGSADIAQACl/71FN9qlrVpwr/ARH/AsxC/wLMQv8CzEIE/wAAAAAAAQAAAgAAAQAJAwAAAgEBCQMAAQMBAwkC"
      "AAICAQICBAEDAQEBAQAJB5ECC7EHIQWhMAawABbeimgUhgxO0rSUwNrpcOiS8uHnXoE4dKi/wbHn28TrcLyHvp3mG/9Xo1vKJAB0"
      "cEBmq2kL3FitrGsqKB8cNl8aN1qPDAD9+TgvAAAAAP8AAACw63u/pQR/vy4Cbb/inPo/CAYDAQAKH30UhSsFaX+N95n8oU2tcpiS"
      "p9afGv/V1tIjUMOn1la3+GrlGBbV4yTmp4Hj+KeGbX9d2v6pqVv/vuGpP/1qUpkD/wEAAP8AAABxBbl2auhKCQUBAQALEyEFB80M"
      "kQKFKwao2nounX7BxiY/ikqb/////////x9o9PLBIfIMSpS3Ub/tSRvvCyfp97E6UK7/05J8hu7yEAbDjURGo6+kSy3J71bgQ8Ff"
      "fwIXAAAAvQX7qAB2gAApAAAA/wMAAKUEf7//mn6/mFL/PwoBAQEACRORAikcfRTNDAhnyaZjRURSQUNPAgIBAQAAABkyMjIyMjIy"
      "MjIyMjIyMjIy/wDE63C8h76d5hv/BqNbaSHPaZGy/gBFODI12R1N/lbDjUUGVWhCABQPkOCga/3/MKAT2bV333xrDgAAAAD9AAAA";
  const auto bytes = read_uri("data:application/octet-stream;base64," + blob, {}, "blob");
  ASSERT_TRUE(bytes);
  EXPECT_EQ(decode_foreign_draco_blob(*bytes, "blob").error().text(), "blob: Draco takes more than 1 s for 525 bytes");
}

TEST(DracoCodec, BrokenBlobsAreRefused) {
  GltfBuilder builder = compressed({3});
  builder.json["bufferViews"][0]["byteLength"] = 20;
  EXPECT_TRUE(verdict(builder).starts_with("meshes[0].primitives[0]: Draco cannot decode it")) << verdict(builder);
  builder = compressed({3});
  builder.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]["POSITION"] = 99;
  EXPECT_EQ(verdict(builder), "meshes[0].primitives[0]: Draco holds no attribute 99");
}

}  // namespace
}  // namespace gltf_radiosity
