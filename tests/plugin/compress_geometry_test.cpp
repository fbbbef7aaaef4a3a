#include "plugin/compress_geometry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "plugin/accessor_view.h"
#include "plugin/write_gltf.h"
#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

Options with_draco() {
  Options options;
  options.draco_bits = 16;
  return options;
}

Options with_meshopt() {
  Options options;
  options.meshopt = true;
  return options;
}

/// A document after compression, and its warnings.
struct Compressed {
  Document document;
  BufferBuilder added;
  std::vector<Warning> warnings;

  Compressed(const GltfBuilder& builder, const Options& options) {
    Result<Document> read = read_document(builder.glb(), {});
    EXPECT_TRUE(read) << read.error().text();
    document = std::move(*read);
    compress_geometry(document, added, options, warnings, {});
  }

  const Json& primitive(std::size_t mesh, std::size_t index = 0) const {
    return document.json["meshes"][mesh]["primitives"][index];
  }
  bool has_draco(std::size_t mesh) const {
    return primitive(mesh).value("extensions", Json::object()).contains("KHR_draco_mesh_compression");
  }
};

/// The first primitive as a reader of the file sees it.
struct FirstPrimitive {
  Document document;

  explicit FirstPrimitive(const Compressed& compressed) : document(read_back(compressed.document, compressed.added)) {}

  RawAccessor rows(const char* semantic) const {
    const Json& attributes = document.json["meshes"][0]["primitives"][0]["attributes"];
    return read_accessor(document, attributes[semantic].get<std::size_t>());
  }
};

/// A strip of unit squares in the plane z = 0.
PrimitiveParts squares(std::uint32_t count) {
  PrimitiveParts parts;
  for (std::uint32_t i = 0; i <= count; ++i) {
    const auto x = static_cast<float>(i);
    parts.positions.insert(parts.positions.end(), {{x, 0.0F, 0.0F}, {x, 1.0F, 0.0F}});
    if (i == count) break;
    const std::uint32_t v = 2 * i;
    parts.indices.insert(parts.indices.end(), {v, v + 2, v + 1, v + 1, v + 2, v + 3});
  }
  return parts;
}

TEST(CompressGeometry, DoesNothingUnlessAsked) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(squares(3)));
  const Compressed compressed(builder, {});
  EXPECT_EQ(compressed.document.json, builder.document().json);
  EXPECT_TRUE(compressed.added.bytes().empty());
}

TEST(CompressGeometry, DracoComesBackAsItWas) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(squares(5)));
  const Compressed compressed(builder, with_draco());
  EXPECT_TRUE(compressed.has_draco(0));
  EXPECT_THAT(compressed.document.json["extensionsRequired"], testing::Contains("KHR_draco_mesh_compression"));

  const Document again = read_back(compressed.document, compressed.added);
  const Json& primitive = again.json["meshes"][0]["primitives"][0];
  const Json& positions = again.json["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
  EXPECT_EQ(positions["count"], 12);
  EXPECT_EQ(positions["min"], Json({0.0, 0.0, 0.0}));
  EXPECT_EQ(positions["max"], Json({5.0, 1.0, 0.0}));
  EXPECT_EQ(again.json["accessors"][primitive["indices"].get<std::size_t>()]["count"], 30);
  // Whole numbers lie on the grid.
  for (const float x : as_floats(read_accessor(again, primitive["attributes"]["POSITION"].get<std::size_t>()))) {
    EXPECT_EQ(x, std::round(x));
  }
}

TEST(CompressGeometry, CustomAttributesJointsAndIntegerColoursComeBackExactly) {
  GltfBuilder builder;
  const PrimitiveParts parts = squares(5);
  const auto heat_at = [](float x, float y) { return glm::vec2(x / 3.0F + 1e-6F * y, 1e20F * (y - x)); };
  const auto byte_at = [](float x, float y, int k) {
    return static_cast<std::uint8_t>(40.0F * x + 3.0F * y + static_cast<float>(k));
  };
  std::vector<glm::vec2> heat;
  Bytes bytes;
  for (const glm::vec3& p : parts.positions) {
    heat.push_back(heat_at(p.x, p.y));
    for (int k = 0; k < 4; ++k) bytes.push_back(byte_at(p.x, p.y, k));
  }
  Json primitive = builder.primitive(parts);
  primitive["attributes"]["_HEAT"] = builder.add_accessor(heat);
  primitive["attributes"]["JOINTS_0"] = builder.add_accessor(bytes, 5121, "VEC4", heat.size());
  primitive["attributes"]["COLOR_0"] = builder.add_accessor(bytes, 5121, "VEC4", heat.size(), true);
  builder.add_node(builder.add_mesh(Json::array({primitive})));
  const Compressed compressed(builder, with_draco());
  ASSERT_TRUE(compressed.has_draco(0));

  const FirstPrimitive again(compressed);
  const std::vector<float> positions = as_floats(again.rows("POSITION")), heats = as_floats(again.rows("_HEAT"));
  const RawAccessor joints = again.rows("JOINTS_0"), colors = again.rows("COLOR_0");
  ASSERT_EQ(joints.count, parts.positions.size());
  EXPECT_TRUE(colors.normalized);
  for (std::size_t v = 0; v < joints.count; ++v) {
    const float x = positions[3 * v], y = positions[3 * v + 1];
    EXPECT_EQ(glm::vec2(heats[2 * v], heats[2 * v + 1]), heat_at(x, y));
    for (int k = 0; k < 4; ++k) {
      EXPECT_EQ(joints.bytes[4 * v + static_cast<std::size_t>(k)], byte_at(x, y, k));
      EXPECT_EQ(colors.bytes[4 * v + static_cast<std::size_t>(k)], byte_at(x, y, k));
    }
  }
}

// Draco gives back other normals than it got if they are integers and called normals.
TEST(CompressGeometry, IntegerNormalsAndTextureCoordinatesComeBackExactly) {
  GltfBuilder builder;
  const PrimitiveParts parts = squares(5);
  const auto normal_at = [](float x, float y, int k) {
    return static_cast<std::uint8_t>(20.0F * x + 7.0F * y + 3.0F * static_cast<float>(k));
  };
  const auto texcoord_at = [](float x, float y) { return static_cast<std::uint8_t>(50.0F * x + y); };
  Bytes normals, texcoords;
  for (const glm::vec3& p : parts.positions) {
    for (int k = 0; k < 4; ++k) normals.push_back(k < 3 ? normal_at(p.x, p.y, k) : std::uint8_t{0});
    for (int k = 0; k < 4; ++k) texcoords.push_back(k == 0 ? texcoord_at(p.x, p.y) : std::uint8_t{0});
  }
  Json primitive = builder.primitive(parts);
  const std::size_t normal = builder.add_accessor(normals, 5120, "VEC3", parts.positions.size(), true);
  builder.json["bufferViews"][builder.json["accessors"][normal]["bufferView"].get<std::size_t>()]["byteStride"] = 4;
  primitive["attributes"]["NORMAL"] = normal;
  primitive["attributes"]["TEXCOORD_0"] = builder.add_accessor(texcoords, 5123, "VEC2", parts.positions.size(), true);
  builder.json["extensionsUsed"] = builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  builder.add_node(builder.add_mesh(Json::array({primitive})));
  const Compressed compressed(builder, with_draco());
  ASSERT_TRUE(compressed.has_draco(0));

  const FirstPrimitive again(compressed);
  const std::vector<float> positions = as_floats(again.rows("POSITION"));
  const RawAccessor normal_rows = again.rows("NORMAL"), texcoord_rows = again.rows("TEXCOORD_0");
  for (std::size_t v = 0; v < normal_rows.count; ++v) {
    const float x = positions[3 * v], y = positions[3 * v + 1];
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(normal_rows.bytes[3 * v + static_cast<std::size_t>(k)], normal_at(x, y, k));
    }
    EXPECT_EQ(texcoord_rows.bytes[4 * v], texcoord_at(x, y));
  }
}

TEST(CompressGeometry, VerticesThatTwoPrimitivesShareStayTogether) {
  // Two meshes of different bounds that meet along an edge at thirds, which no grid holds.
  const auto strip = [](float begin, float end) {
    PrimitiveParts parts;
    parts.positions = {
        {begin / 3.0F, 0.1F, 0.7F}, {end / 3.0F, 0.1F, 0.7F}, {begin / 3.0F, 1.3F, 0.7F}, {end / 3.0F, 1.3F, 0.7F}};
    parts.indices = {0, 1, 2, 2, 1, 3};
    return parts;
  };
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(strip(-10.0F, 1.0F)));
  builder.add_node(builder.add_mesh(strip(1.0F, 7.0F)));
  const Compressed compressed(builder, with_draco());
  const Document again = read_back(compressed.document, compressed.added);
  const auto bound = [&](std::size_t mesh, const char* which) {
    const Json& primitive = again.json["meshes"][mesh]["primitives"][0];
    return again.json["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()][which][0].get<float>();
  };
  EXPECT_EQ(bound(0, "max"), bound(1, "min"));
  EXPECT_NEAR(bound(0, "max"), 1.0F / 3.0F, 1e-4F);
}

TEST(CompressGeometry, TrianglesThatAreNoneAreLeftOut) {
  PrimitiveParts parts = squares(2);
  parts.indices.insert(parts.indices.end(), {1, 1, 2, 3, 0, 0});
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(parts));
  for (const Options& options : {with_draco(), with_meshopt()}) {
    const Compressed compressed(builder, options);
    const auto indices = compressed.primitive(0)["indices"].get<std::size_t>();
    EXPECT_EQ(compressed.document.json["accessors"][indices]["count"], 12);
  }
}

TEST(CompressGeometry, WhatCannotBeCompressedStaysAndSaysWhy) {
  GltfBuilder builder;
  PrimitiveParts flat = squares(1);
  flat.indices = {0, 0, 1};
  PrimitiveParts infinite = squares(1);
  infinite.texcoords.assign(4, {0.0F, std::numeric_limits<float>::infinity()});
  builder.add_node(builder.add_mesh(flat));
  builder.add_node(builder.add_mesh(infinite));
  builder.add_node(builder.add_mesh(squares(1)));
  builder.json["meshes"][2]["primitives"][0]["extensions"]["CESIUM_primitive_outline"] = {{"indices", 0}};
  builder.add_node(builder.add_mesh(squares(2)));
  for (const Options& options : {with_draco(), with_meshopt()}) {
    const Compressed compressed(builder, options);
    std::vector<std::string> places;
    for (const Warning& warning : compressed.warnings) {
      EXPECT_EQ(warning.code, "not-compressed") << warning.message;
      places.push_back(warning.place);
    }
    EXPECT_THAT(places, testing::UnorderedElementsAre("meshes[0].primitives[0]", "meshes[1].primitives[0]",
                                                      "meshes[2].primitives[0]"));
    // What is left alone keeps its data.
    const auto old = compressed.primitive(1)["attributes"]["TEXCOORD_0"].get<std::size_t>();
    EXPECT_EQ(as_floats(read_accessor(compressed.document, old))[1], std::numeric_limits<float>::infinity());
  }
}

TEST(CompressGeometry, PointsAndLinesAreLeftAlone) {
  GltfBuilder builder;
  PrimitiveParts points = squares(1);
  points.mode = 0;
  builder.add_node(builder.add_mesh(points));
  builder.add_node(builder.add_mesh(squares(1)));
  const Compressed compressed(builder, with_draco());
  EXPECT_FALSE(compressed.has_draco(0));
  EXPECT_TRUE(compressed.has_draco(1));
  EXPECT_TRUE(compressed.warnings.empty());
}

TEST(CompressGeometry, ASecondMeshOfTheSameAccessorsCostsNothing) {
  GltfBuilder one;
  one.add_node(one.add_mesh(squares(9)));
  GltfBuilder two = one;
  two.json["meshes"].push_back(two.json["meshes"][0]);
  for (const Options& options : {with_draco(), with_meshopt()}) {
    EXPECT_EQ(Compressed(two, options).added.bytes(), Compressed(one, options).added.bytes());
  }
}

TEST(CompressGeometry, MeshoptSharesWhatWasShared) {
  // Two nodes' meshes that differ in their colours only.
  GltfBuilder builder;
  PrimitiveParts parts = squares(4);
  parts.colors.assign(10, {1.0F, 0.5F, 0.25F, 1.0F});
  builder.add_node(builder.add_mesh(parts));
  builder.json["meshes"].push_back(builder.json["meshes"][0]);
  const std::size_t other = builder.add_accessor(std::vector<glm::vec4>(10, {0.0F, 1.0F, 0.0F, 1.0F}));
  builder.json["meshes"][1]["primitives"][0]["attributes"]["COLOR_0"] = other;
  const Compressed compressed(builder, with_meshopt());
  const Json &first = compressed.primitive(0), &second = compressed.primitive(1);
  EXPECT_EQ(first["attributes"]["POSITION"], second["attributes"]["POSITION"]);
  EXPECT_EQ(first["indices"], second["indices"]);
  EXPECT_NE(first["attributes"]["COLOR_0"], second["attributes"]["COLOR_0"]);
}

TEST(CompressGeometry, MeshoptBufferViewsDecodeIntoABufferWithoutData) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(squares(4)));
  Compressed compressed(builder, with_meshopt());
  const Result<Bytes> glb = to_glb(std::move(compressed.document), compressed.added);
  ASSERT_TRUE(glb);
  const std::uint32_t length = (*glb)[12] | static_cast<std::uint32_t>((*glb)[13]) << 8U;
  const Json root = Json::parse(glb->begin() + 20, glb->begin() + 20 + length);
  ASSERT_EQ(root["buffers"].size(), 2U);
  EXPECT_EQ(root["buffers"][1]["extensions"]["EXT_meshopt_compression"], Json({{"fallback", true}}));
  EXPECT_FALSE(root["buffers"][1].contains("uri"));
  for (const Json& view : root["bufferViews"]) {
    const Json& extension = view["extensions"]["EXT_meshopt_compression"];
    EXPECT_EQ(view["buffer"], 1);
    EXPECT_EQ(extension["buffer"], 0);
    EXPECT_EQ(view["byteLength"], extension["count"].get<std::size_t>() * extension["byteStride"].get<std::size_t>());
    const auto end = view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>();
    EXPECT_LE(end, root["buffers"][1]["byteLength"].get<std::size_t>());
  }
}

}  // namespace
}  // namespace gltf_radiosity
