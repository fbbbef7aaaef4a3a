#include "plugin/append_accessor.h"

#include <gtest/gtest.h>

namespace gltf_radiosity {
namespace {

/// What a reader of the file gets: `added` is the document's only buffer.
RawAccessor written_and_read(Document document, const BufferBuilder& added, std::size_t accessor) {
  document.buffers.push_back(added.bytes());
  return read_accessor(document, accessor);
}

TEST(AppendAccessor, WhatIsAppendedIsRead) {
  Document document;
  BufferBuilder added;
  const RawAccessor raw{ComponentType::kI16, 2, true, 3, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}};
  const std::size_t index = append_accessor(document, added, raw, BufferTarget::kVertices);
  const RawAccessor again = written_and_read(document, added, index);
  EXPECT_EQ(again.bytes, raw.bytes);
  EXPECT_EQ(again.component, raw.component);
  EXPECT_TRUE(again.normalized);
  EXPECT_EQ(document.json["bufferViews"][0]["target"], 34962);
  EXPECT_FALSE(document.json["bufferViews"][0].contains("byteStride"));
}

TEST(AppendAccessor, RowsOfVerticesAreAlignedToFourBytes) {
  Document document;
  BufferBuilder added;
  const RawAccessor raw{ComponentType::kU8, 3, true, 2, {1, 2, 3, 4, 5, 6}};
  const std::size_t index = append_accessor(document, added, raw, BufferTarget::kVertices);
  EXPECT_EQ(added.bytes(), (Bytes{1, 2, 3, 0, 4, 5, 6, 0}));
  EXPECT_EQ(document.json["bufferViews"][0]["byteStride"], 4);
  EXPECT_EQ(written_and_read(document, added, index).bytes, raw.bytes);
}

TEST(AppendAccessor, IndicesAreNotPadded) {
  Document document;
  BufferBuilder added;
  const RawAccessor raw{ComponentType::kU16, 1, false, 3, {0, 0, 1, 0, 2, 0}};
  append_accessor(document, added, raw, BufferTarget::kIndices);
  EXPECT_EQ(added.bytes().size(), 6U);
  EXPECT_EQ(document.json["bufferViews"][0]["target"], 34963);
}

TEST(AppendAccessor, DataStartsAtMultiplesOfFour) {
  Document document;
  BufferBuilder added;
  const RawAccessor raw{ComponentType::kU16, 1, false, 3, {0, 0, 1, 0, 2, 0}};
  append_accessor(document, added, raw, BufferTarget::kIndices);
  const std::size_t second = append_accessor(document, added, raw, BufferTarget::kIndices);
  EXPECT_EQ(document.json["bufferViews"][1]["byteOffset"], 8);
  EXPECT_EQ(written_and_read(document, added, second).bytes, raw.bytes);
}

TEST(AppendAccessor, TheNewBufferIsTheLastOne) {
  Document document;
  document.buffers.resize(2);
  BufferBuilder added;
  append_accessor(document, added, {ComponentType::kU8, 1, false, 1, {7}}, BufferTarget::kVertices);
  EXPECT_EQ(document.json["bufferViews"][0]["buffer"], 2);
}

TEST(AppendAccessor, BoundsAreThoseOfTheStoredType) {
  Document document;
  BufferBuilder added;
  const RawAccessor raw{ComponentType::kI8, 1, true, 3, {0x80, 0x7f, 0x01}};
  append_accessor(document, added, raw, BufferTarget::kVertices, Json::object(), true);
  EXPECT_EQ(document.json["accessors"][0]["min"], Json::array({-128}));
  EXPECT_EQ(document.json["accessors"][0]["max"], Json::array({127}));
}

TEST(AppendAccessor, BoundsOfFloatsAreExact) {
  Document document;
  BufferBuilder added;
  const RawAccessor raw{ComponentType::kF32, 2, false, 2,
                        encode_floats({0.1F, -5.0F, 0.3F, 7.0F}, ComponentType::kF32, false)};
  append_accessor(document, added, raw, BufferTarget::kVertices, Json::object(), true);
  const Json parsed = Json::parse(document.json["accessors"][0].dump());
  EXPECT_EQ(parsed["min"][0].get<float>(), 0.1F);
  EXPECT_EQ(parsed["min"][1].get<float>(), -5.0F);
  EXPECT_EQ(parsed["max"][0].get<float>(), 0.3F);
}

TEST(AppendAccessor, WhatDoesNotDescribeTheDataIsTakenOver) {
  Document document;
  BufferBuilder added;
  const Json like = Json::parse(R"({"bufferView": 9, "byteOffset": 4, "componentType": 5126, "count": 99,
    "type": "SCALAR", "name": "heat", "extras": {"unit": "K"}, "max": [5], "min": [1],
    "sparse": {"count": 1}, "normalized": true})");
  const RawAccessor raw{ComponentType::kU8, 1, false, 2, {3, 4}};
  append_accessor(document, added, raw, BufferTarget::kVertices, like);
  const Json& accessor = document.json["accessors"][0];
  EXPECT_EQ(accessor["name"], "heat");
  EXPECT_EQ(accessor["extras"]["unit"], "K");
  EXPECT_EQ(accessor["count"], 2);
  EXPECT_EQ(accessor["max"], Json::array({4}));
  for (const char* gone : {"byteOffset", "sparse", "normalized"}) EXPECT_FALSE(accessor.contains(gone)) << gone;
}

TEST(AppendAccessor, ColumnsOfMatricesArePadded) {
  Document document;
  BufferBuilder added;
  const RawAccessor raw{ComponentType::kU8, 4, false, 1, {1, 2, 3, 4}};
  const std::size_t index = append_accessor(document, added, raw, BufferTarget::kVertices, {{"type", "MAT2"}});
  EXPECT_EQ(added.bytes(), (Bytes{1, 2, 0, 0, 3, 4, 0, 0}));
  EXPECT_EQ(written_and_read(document, added, index).bytes, raw.bytes);
}

}  // namespace
}  // namespace gltf_radiosity
