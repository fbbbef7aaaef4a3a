#include "plugin/meshopt_decode.h"

#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>

#include "plugin/accessor_view.h"
#include "plugin/base64.h"
#include "tests/plugin/gltf_builder.h"

namespace gltf_radiosity {
namespace {

constexpr const char* kMeshopt = "EXT_meshopt_compression";

/// What goes into a stream.
struct StreamContent {
  std::string mode, filter;
  std::size_t count, stride;
  Bytes encoded;
};

Bytes encode_rows(const Bytes& rows, std::size_t stride) {
  const std::size_t count = rows.size() / stride;
  Bytes bytes(meshopt_encodeVertexBufferBound(count, stride));
  bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), rows.data(), count, stride));
  return bytes;
}

StreamContent plain_rows(const Bytes& rows, std::size_t stride) {
  return {"ATTRIBUTES", "NONE", rows.size() / stride, stride, encode_rows(rows, stride)};
}

StreamContent index_stream(const std::vector<unsigned>& indices) {
  Bytes bytes(meshopt_encodeIndexSequenceBound(indices.size(), 100));
  bytes.resize(meshopt_encodeIndexSequence(bytes.data(), bytes.size(), indices.data(), indices.size()));
  return {"INDICES", "NONE", indices.size(), 2, bytes};
}

StreamContent triangle_stream(const std::vector<unsigned>& indices) {
  Bytes bytes(meshopt_encodeIndexBufferBound(indices.size(), 100));
  bytes.resize(meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), indices.data(), indices.size()));
  return {"TRIANGLES", "NONE", indices.size(), 4, bytes};
}

using EncodeFilter = void (*)(void*, std::size_t, std::size_t, int, const float*);

/// Rows of four floats (unit vectors, quaternions, or any numbers) as `filter` stores them.
StreamContent filtered(const std::string& filter, EncodeFilter encode, std::size_t stride, int bits,
                       const std::vector<float>& rows) {
  const std::size_t count = rows.size() / 4;
  Bytes encoded(count * stride);
  encode(encoded.data(), count, stride, bits, rows.data());
  return {"ATTRIBUTES", filter, count, stride, encode_rows(encoded, stride)};
}

/// The buffer with the compressed bytes, and one that only says how long the decoded ones are.
Json buffers_with_placeholder(std::size_t decoded_size, const std::string& extension) {
  Json placeholder;
  placeholder["byteLength"] = decoded_size;
  placeholder["extensions"][extension]["fallback"] = true;
  return Json::array({Json::object(), placeholder});
}

/// A glTF whose bufferViews are these streams, in a placeholder without data; scalars of 8 bits read them.
GltfBuilder with_streams(const std::vector<StreamContent>& contents, const std::string& extension = kMeshopt) {
  GltfBuilder builder;
  std::size_t offset = 0;
  for (const StreamContent& content : contents) {
    const std::size_t view = builder.add_buffer_view(content.encoded);
    const std::size_t size = content.count * content.stride;
    Json& json = builder.json["bufferViews"][view];
    json["extensions"][extension] = {{"buffer", 0},
                                     {"byteOffset", json.value("byteOffset", 0)},
                                     {"byteLength", content.encoded.size()},
                                     {"byteStride", content.stride},
                                     {"count", content.count},
                                     {"mode", content.mode},
                                     {"filter", content.filter}};
    json["buffer"] = 1;
    json["byteOffset"] = offset;
    json["byteLength"] = size;
    offset += (size + 3) / 4 * 4;
    builder.json["accessors"].push_back(
        {{"bufferView", view}, {"componentType", 5121}, {"count", size}, {"type", "SCALAR"}});
  }
  builder.json["extensionsUsed"] = {extension, "KHR_mesh_quantization"};
  builder.json["extensionsRequired"] = {extension};
  builder.json["buffers"] = buffers_with_placeholder(offset, extension);
  return builder;
}

Json& stream_of(GltfBuilder& builder, std::size_t view = 0) {
  return builder.json["bufferViews"][view]["extensions"][kMeshopt];
}

Result<Document> read_streams(const GltfBuilder& builder) { return read_document(builder.glb(), {}); }

std::string meshopt_verdict(const GltfBuilder& builder) {
  const auto document = read_streams(builder);
  return document ? "fine" : document.error().text();
}

/// The decoded bytes of accessor `index` as values of type T.
template <typename T>
std::vector<T> decoded_as(const Document& document, std::size_t index) {
  const Bytes bytes = read_accessor(document, index).bytes;
  std::vector<T> result(bytes.size() / sizeof(T));
  std::memcpy(result.data(), bytes.data(), bytes.size());
  return result;
}

const Bytes kRows = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};

TEST(MeshoptDecode, GivesBackWhatWasEncodedInEveryMode) {
  const auto document = read_streams(
      with_streams({plain_rows(kRows, 4), index_stream({5, 0, 99, 7}), triangle_stream({0, 1, 2, 2, 1, 3})}));
  ASSERT_TRUE(document) << document.error().text();
  EXPECT_EQ(decoded_as<std::uint8_t>(*document, 0), kRows);
  EXPECT_EQ(decoded_as<std::uint16_t>(*document, 1), (std::vector<std::uint16_t>{5, 0, 99, 7}));
  EXPECT_EQ(decoded_as<std::uint32_t>(*document, 2), (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3}));
}

TEST(MeshoptDecode, FiltersGiveUnitVectorsQuaternionsAndFloats) {
  const float half = std::sqrt(0.5F);
  const auto document =
      read_streams(with_streams({filtered("OCTAHEDRAL", meshopt_encodeFilterOct, 4, 8, {0, 0, 1, 1, half, 0, -half, 1}),
                                 filtered("OCTAHEDRAL", meshopt_encodeFilterOct, 8, 16, {0, -1, 0, 1}),
                                 filtered("QUATERNION", meshopt_encodeFilterQuat, 8, 16, {0, half, 0, half}),
                                 filtered("EXPONENTIAL", meshopt_encodeFilterExp, 16, 24, {0.5F, -3.25F, 1024, 0})}));
  ASSERT_TRUE(document) << document.error().text();
  const std::vector<std::int8_t> normals = decoded_as<std::int8_t>(*document, 0);
  const std::vector<int> expected = {0, 0, 127, 127, 90, 0, -90, 127};
  for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_NEAR(normals[k], expected[k], 1) << k;
  EXPECT_EQ(decoded_as<std::int16_t>(*document, 1), (std::vector<std::int16_t>{0, -32767, 0, 32767}));
  const std::vector<std::int16_t> turn = decoded_as<std::int16_t>(*document, 2);
  EXPECT_NEAR(turn[1], 32767 * half, 2);
  EXPECT_NEAR(turn[3], 32767 * half, 2);
  EXPECT_EQ(decoded_as<float>(*document, 3), (std::vector<float>{0.5F, -3.25F, 1024, 0}));
}

TEST(MeshoptDecode, LeavesNoTraceOfTheExtensionNorOfTheCompressedBytes) {
  for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    GltfBuilder builder = with_streams({plain_rows(kRows, 4)}, extension);
    builder.json["buffers"][0]["name"] = "geometry";
    const auto document = read_streams(builder);
    ASSERT_TRUE(document) << document.error().text();
    EXPECT_EQ(document->json.dump().find("meshopt"), std::string::npos) << document->json.dump();
    EXPECT_EQ(document->json["extensionsUsed"], Json::array({"KHR_mesh_quantization"}));
    EXPECT_EQ(document->json["buffers"], Json::parse(R"([{"name": "geometry", "byteLength": 0}, {"byteLength": 12}])"));
    EXPECT_EQ(document->buffers, (std::vector<Bytes>{{}, kRows}));
  }
}

TEST(MeshoptDecode, PlainDataBesideStreamsKeepsItsBytes) {
  GltfBuilder builder = with_streams({plain_rows(kRows, 4), plain_rows(kRows, 4)});
  builder.json["buffers"] = Json::array();
  const Bytes image = {200, 201, 202, 203, 204};
  const std::size_t plain = builder.add_buffer_view(image);
  stream_of(builder, 1) = stream_of(builder, 0);  // both read the first stream; the bytes of the second stay
  builder.json["buffers"] = buffers_with_placeholder(24, kMeshopt);
  builder.json["accessors"].push_back(
      {{"bufferView", plain}, {"componentType", 5121}, {"count", 5}, {"type", "SCALAR"}});
  const auto document = read_streams(builder);
  ASSERT_TRUE(document) << document.error().text();
  EXPECT_EQ(decoded_as<std::uint8_t>(*document, 0), kRows);
  EXPECT_EQ(decoded_as<std::uint8_t>(*document, 1), kRows);
  EXPECT_EQ(decoded_as<std::uint8_t>(*document, 2), image);
  EXPECT_LT(document->buffers[0].size(), builder.buffer().size());
  EXPECT_EQ(document->json["bufferViews"][plain]["byteOffset"].get<std::size_t>() % 4, 0U);
}

TEST(MeshoptDecode, AFallbackIsNotNeededEvenIfItHasData) {
  for (const std::string& uri : {"data:;base64," + encode_base64(Bytes(12, 77)), std::string("gone.bin")}) {
    GltfBuilder builder = with_streams({plain_rows(kRows, 4)});
    builder.json["buffers"][1]["uri"] = uri;
    const auto document = read_streams(builder);
    ASSERT_TRUE(document) << document.error().text();
    EXPECT_EQ(decoded_as<std::uint8_t>(*document, 0), kRows);
    EXPECT_EQ(document->buffers.size(), 2U) << "the emptied first one and the decoded data";
  }
}

TEST(MeshoptDecode, BoundsAreThoseOfTheDecodedValues) {
  GltfBuilder builder =
      with_streams({filtered("EXPONENTIAL", meshopt_encodeFilterExp, 16, 4, {0.3F, 1, 2, 3}), plain_rows(kRows, 4)});
  builder.json["accessors"][0] = {{"bufferView", 0}, {"componentType", 5126}, {"count", 1}, {"type", "VEC4"}};
  builder.json["accessors"][0]["min"] = builder.json["accessors"][0]["max"] = {0.3, 1, 2, 3};
  builder.json["accessors"][1]["max"] = {12.0};
  const auto document = read_streams(builder);
  ASSERT_TRUE(document) << document.error().text();
  const auto decoded = decoded_as<float>(*document, 0)[0];
  EXPECT_NE(decoded, 0.3F);
  EXPECT_EQ(document->json["accessors"][0]["min"][0].get<float>(), decoded);
  EXPECT_EQ(document->json["accessors"][1]["max"].dump(), "[12.0]") << "what is right stays as it was written";
}

TEST(MeshoptDecode, BrokenStreamsAreRefusedByTheirPlace) {
  GltfBuilder builder = with_streams({plain_rows(kRows, 4)});
  stream_of(builder)["byteLength"] = 20;
  EXPECT_EQ(meshopt_verdict(builder), "bufferViews[0]: meshoptimizer cannot decode it");

  StreamContent newer = plain_rows(kRows, 4);
  newer.encoded[0] = 0xa1;
  EXPECT_EQ(meshopt_verdict(with_streams({newer})),
            "bufferViews[0]: version 1 of meshopt's vertex codec is not supported, 0 is");

  builder = with_streams({index_stream({1, 2, 3})});
  stream_of(builder)["mode"] = "TRIANGLES";
  EXPECT_EQ(meshopt_verdict(builder), "bufferViews[0]: meshoptimizer cannot decode it");
}

TEST(MeshoptDecode, WhatDoesNotAddUpIsRefusedBeforeMemoryIsAskedFor) {
  const auto changed = [](const char* key, const Json& value) {
    GltfBuilder builder = with_streams({plain_rows(kRows, 4)});
    stream_of(builder)[key] = value;
    return meshopt_verdict(builder);
  };
  EXPECT_EQ(changed("buffer", 7), "bufferViews[0]: \"buffer\" refers to buffers[7], but there are 2");
  EXPECT_EQ(changed("byteLength", 5000), "bufferViews[0]: its compressed bytes reach beyond buffers[0]");
  EXPECT_EQ(changed("byteStride", 6),
            "bufferViews[0]: no meshopt stream of mode \"ATTRIBUTES\" has 3 elements of 6 bytes");
  EXPECT_EQ(changed("mode", "WISHES"),
            "bufferViews[0]: no meshopt stream of mode \"WISHES\" has 3 elements of 4 bytes");
  EXPECT_EQ(changed("filter", "COLOR"),
            "bufferViews[0]: meshopt filter \"COLOR\" is not supported for elements of 4 bytes in mode ATTRIBUTES");
  EXPECT_EQ(changed("count", 4), "bufferViews[0]: its byteLength is not that of 4 elements of 4 bytes");
  EXPECT_EQ(changed("count", -1), "bufferViews[0]: \"count\" is not a whole number in range");

  const std::size_t huge = std::size_t{1} << 38;
  GltfBuilder builder = with_streams({plain_rows(kRows, 4)});
  stream_of(builder)["count"] = huge;
  builder.json["bufferViews"][0]["byteLength"] = builder.json["buffers"][1]["byteLength"] = 4 * huge;
  EXPECT_EQ(meshopt_verdict(builder), "bufferViews[0]: 61 compressed bytes cannot hold 1099511627776");
}

TEST(MeshoptDecode, ReplacingAnyValueNeverCrashes) {
  const GltfBuilder sound = with_streams({plain_rows(kRows, 4), triangle_stream({0, 1, 2})});
  std::size_t fine = 0, refused = 0;
  const Json flat = sound.json.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    if (pointer == "/buffers/0") continue;  // the builder's own
    for (const Json& other :
         {Json(nullptr), Json(-1), Json(1e300), Json("x"), Json::array(), Json::object(), Json(3)}) {
      GltfBuilder changed = sound;
      changed.json[Json::json_pointer(pointer)] = other;
      ++(read_streams(changed) ? fine : refused);
    }
  }
  EXPECT_GT(fine, 0U);
  EXPECT_GT(refused, 0U);
}

TEST(MeshoptDecode, FlippedBytesNeverCrash) {
  for (const StreamContent& content :
       {plain_rows(Bytes(256, 5), 16), index_stream({5, 0, 99, 7}), triangle_stream({0, 1, 2, 2, 1, 3})}) {
    for (std::size_t at = 0; at < content.encoded.size(); ++at) {
      for (int bit = 0; bit < 8; ++bit) {
        StreamContent flipped = content;
        flipped.encoded[at] ^= static_cast<std::uint8_t>(1U << bit);
        const auto document = read_streams(with_streams({flipped}));
        EXPECT_TRUE(document || document.error().place == "bufferViews[0]");
      }
    }
  }
}

TEST(MeshoptDecode, PlainDataInAPlaceholderIsRefused) {
  GltfBuilder builder = with_streams({plain_rows(kRows, 4)});
  builder.json["bufferViews"][0].erase("extensions");
  EXPECT_EQ(meshopt_verdict(builder),
            "bufferViews[0]: lies in buffers[1], which has no data but of compressed bufferViews");
}

}  // namespace
}  // namespace gltf_radiosity
