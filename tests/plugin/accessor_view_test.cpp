#include "plugin/accessor_view.h"

#include <gtest/gtest.h>

#include "tests/plugin/gltf_builder.h"

namespace gltf_radiosity {
namespace {

TEST(AccessorView, RemovesStrides) {
  GltfBuilder builder;
  const std::vector<std::uint8_t> bytes = {1, 2, 99, 99, 3, 4, 99, 99, 5, 6};
  const std::size_t accessor = builder.add_accessor(bytes, 5121, "VEC2", 3);
  builder.json["bufferViews"][0]["byteStride"] = 4;
  const RawAccessor raw = read_accessor(builder.document(), accessor);
  EXPECT_EQ(raw.bytes, (Bytes{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(as_indices(raw), (std::vector<std::uint32_t>{1, 2, 3, 4, 5, 6}));
}

TEST(AccessorView, AddsBothByteOffsets) {
  GltfBuilder builder;
  builder.add_buffer_view(std::vector<std::uint8_t>{77});
  const std::size_t accessor = builder.add_accessor(std::vector<std::uint8_t>{0, 10, 20, 30}, 5121, "SCALAR", 3);
  builder.json["accessors"][accessor]["byteOffset"] = 1;
  EXPECT_EQ(as_indices(read_accessor(builder.document(), accessor)), (std::vector<std::uint32_t>{10, 20, 30}));
}

TEST(AccessorView, RemovesThePaddingOfMatrixColumns) {
  GltfBuilder builder;
  const std::vector<std::uint8_t> bytes = {1, 2, 99, 99, 3, 4, 99, 99};
  const std::size_t accessor = builder.add_accessor(bytes, 5121, "MAT2", 1);
  const RawAccessor raw = read_accessor(builder.document(), accessor);
  EXPECT_EQ(raw.components, 4);
  EXPECT_EQ(raw.bytes, (Bytes{1, 2, 3, 4}));
}

TEST(AccessorView, KnowsTheSizesOfPaddedElements) {
  EXPECT_EQ(element_layout("MAT3", 5123)->size, 24U);
  EXPECT_EQ(element_layout("MAT3", 5121)->size, 12U);
  EXPECT_EQ(element_layout("VEC3", 5121)->size, 3U);
  EXPECT_EQ(element_layout("MAT4", 5126)->size, 64U);
  EXPECT_FALSE(element_layout("VEC5", 5126));
  EXPECT_FALSE(element_layout("VEC3", 5124));
}

TEST(AccessorView, AppliesSparseValuesOnZeros) {
  GltfBuilder builder;
  const std::size_t indices = builder.add_buffer_view(std::vector<std::uint8_t>{1, 3});
  const std::vector<float> values = {5.0F, 7.0F};
  const std::size_t view = builder.add_buffer_view({reinterpret_cast<const std::uint8_t*>(values.data()), 8});
  builder.json["accessors"].push_back({{"componentType", 5126},
                                       {"count", 4},
                                       {"type", "SCALAR"},
                                       {"sparse",
                                        {{"count", 2},
                                         {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", view}}}}}});
  EXPECT_EQ(as_floats(read_accessor(builder.document(), 0)), (std::vector<float>{0, 5, 0, 7}));
}

TEST(AccessorView, NormalisesIntegersAsTheSpecificationSays) {
  const RawAccessor bytes{ComponentType::kI8, 1, true, 4, {127, 0, 129, 128}};
  EXPECT_EQ(as_floats(bytes), (std::vector<float>{1, 0, -1, -1})) << "-128 is clamped to -1";
  const RawAccessor shorts{ComponentType::kU16, 1, true, 2, {255, 255, 0, 0}};
  EXPECT_EQ(as_floats(shorts), (std::vector<float>{1, 0}));
  const RawAccessor plain{ComponentType::kI8, 1, false, 1, {128}};
  EXPECT_EQ(as_floats(plain), (std::vector<float>{-128}));
}

TEST(AccessorView, EncodesWhatItDecodes) {
  for (const ComponentType type : {ComponentType::kI8, ComponentType::kU8, ComponentType::kI16, ComponentType::kU16}) {
    for (const bool normalized : {false, true}) {
      RawAccessor raw{type, 1, normalized, 0, {}};
      for (int byte = 0; byte < 128; ++byte) raw.bytes.push_back(static_cast<std::uint8_t>(byte));
      raw.count = raw.bytes.size() / component_size(type);
      EXPECT_EQ(encode_floats(as_floats(raw), type, normalized), raw.bytes) << static_cast<int>(type);
    }
  }
}

TEST(AccessorView, ClampsWhatDoesNotFit) {
  EXPECT_EQ(encode_floats({2.0F, -1.0F, 0.5F}, ComponentType::kU8, true), (Bytes{255, 0, 128}));
  EXPECT_EQ(encode_floats({300.0F, -3.0F}, ComponentType::kU8, false), (Bytes{255, 0}));
}

}  // namespace
}  // namespace gltf_radiosity
