#include "plugin/export_meshes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <glm/geometric.hpp>
#include <numbers>

#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

constexpr radiosity::Rgb kLight(1.0F);

/// The only primitive of a builder's only node, cut `levels` times, as a reader of the file sees it.
struct ExportedPrimitive {
  Document document;
  Json primitive;

  RawAccessor attribute(const std::string& semantic) const {
    return read_accessor(document, primitive["attributes"][semantic].get<std::size_t>());
  }
  const Json& accessor(const std::string& semantic) const {
    return document.json["accessors"][primitive["attributes"][semantic].get<std::size_t>()];
  }
  std::vector<std::uint32_t> indices() const {
    return as_indices(read_accessor(document, primitive["indices"].get<std::size_t>()));
  }
  std::vector<glm::vec3> positions() const {
    const std::vector<float> values = as_floats(attribute("POSITION"));
    std::vector<glm::vec3> result(values.size() / 3);
    std::memcpy(result.data(), values.data(), values.size() * sizeof(float));
    return result;
  }
};

ExportedPrimitive export_first(const GltfBuilder& builder, int levels) {
  HandBake hand = bake_by_hand(builder, levels, kLight);
  const auto refined = split_by_instance(hand.bake.mesh, hand.scene);
  Json primitive = hand.document.json["meshes"][0]["primitives"][0];
  export_geometry(hand.document, hand.added, hand.scene.instances[0], refined[0], primitive);
  hand.document.buffers.push_back(hand.added.bytes());
  return {std::move(hand.document), std::move(primitive)};
}

GltfBuilder one_mesh(const PrimitiveParts& parts) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(parts));
  return builder;
}

glm::vec3 area_vector(const ExportedPrimitive& exported) {
  const std::vector<glm::vec3> positions = exported.positions();
  const std::vector<std::uint32_t> indices = exported.indices();
  glm::vec3 sum(0.0F);
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const glm::vec3& a = positions[indices[i]];
    sum += 0.5F * glm::cross(positions[indices[i + 1]] - a, positions[indices[i + 2]] - a);
  }
  return sum;
}

TEST(ExportMeshes, AnUncutInstanceIsUnchanged) {
  const HandBake hand = bake_by_hand(one_mesh(unit_square()), 0, kLight);
  const auto refined = split_by_instance(hand.bake.mesh, hand.scene);
  ASSERT_EQ(refined.size(), 1U);
  EXPECT_FALSE(refined[0].changed);
  EXPECT_THAT(refined[0].vertices, testing::ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(refined[0].triangles, testing::ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)));
}

TEST(ExportMeshes, EveryInstanceCountsFromZero) {
  GltfBuilder builder;
  const std::size_t mesh = builder.add_mesh(unit_square());
  builder.add_node(mesh);
  builder.add_node(mesh, {{"translation", {5.0, 0.0, 0.0}}});
  const HandBake hand = bake_by_hand(builder, 1, kLight);
  const auto refined = split_by_instance(hand.bake.mesh, hand.scene);
  ASSERT_EQ(refined.size(), 2U);
  for (const RefinedPrimitive& primitive : refined) {
    EXPECT_TRUE(primitive.changed);
    EXPECT_EQ(primitive.vertices.size(), 9U);
    EXPECT_EQ(primitive.cuts.size(), 5U);
    EXPECT_EQ(primitive.source_vertex_count(), 4U);
    EXPECT_EQ(primitive.triangles.size(), 8U);
    EXPECT_EQ(primitive.elements.size(), 8U);
    for (const glm::uvec3& t : primitive.triangles) EXPECT_LT(std::max({t.x, t.y, t.z}), 9U);
  }
  EXPECT_EQ(refined[1].vertices[0], 4U);
}

TEST(ExportMeshes, MidpointsComeAfterTheirEnds) {
  const HandBake hand = bake_by_hand(one_mesh(unit_square()), 3, kLight);
  const auto refined = split_by_instance(hand.bake.mesh, hand.scene);
  for (std::uint32_t k = 0; k < refined[0].cuts.size(); ++k) {
    EXPECT_LT(refined[0].cuts[k].ends.x, 4 + k);
    EXPECT_LT(refined[0].cuts[k].ends.y, 4 + k);
  }
}

TEST(ExportMeshes, OldVerticesKeepTheirBytes) {
  PrimitiveParts parts = unit_square();
  parts.positions[2] = {1.0F / 3.0F, -0.0F, 1e-7F};
  parts.normals[1] = {0.1F, 0.9F, 0.123456F};
  const GltfBuilder builder = one_mesh(parts);
  const ExportedPrimitive exported = export_first(builder, 2);
  for (const char* semantic : {"POSITION", "NORMAL", "TEXCOORD_0"}) {
    const Document before = builder.document();
    const RawAccessor old =
        read_accessor(before, before.json["meshes"][0]["primitives"][0]["attributes"][semantic].get<std::size_t>());
    const RawAccessor fresh = exported.attribute(semantic);
    ASSERT_EQ(fresh.count, 25U);
    EXPECT_EQ(std::memcmp(old.bytes.data(), fresh.bytes.data(), old.bytes.size()), 0) << semantic;
  }
}

TEST(ExportMeshes, AttributesStayLinearOverTheSurface) {
  const ExportedPrimitive exported = export_first(one_mesh(unit_square()), 3);
  const std::vector<glm::vec3> positions = exported.positions();
  const std::vector<float> texcoords = as_floats(exported.attribute("TEXCOORD_0"));
  for (std::size_t v = 0; v < positions.size(); ++v) {
    EXPECT_EQ(texcoords[2 * v], positions[v].x);  // unit_square: u = x, v = z
    EXPECT_EQ(texcoords[2 * v + 1], positions[v].z);
  }
}

TEST(ExportMeshes, AreaAndOrientationAreKept) {
  EXPECT_LT(glm::distance(area_vector(export_first(one_mesh(unit_square()), 2)), glm::vec3(0, 1, 0)), 1e-6F);
}

TEST(ExportMeshes, AMirroredNodeKeepsTheWindingOfItsMesh) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(unit_square()), {{"scale", {-1.0, 1.0, 1.0}}});
  EXPECT_LT(glm::distance(area_vector(export_first(builder, 1)), glm::vec3(0, 1, 0)), 1e-6F);
}

TEST(ExportMeshes, BoundsOfPositionsAreGiven) {
  const ExportedPrimitive exported = export_first(one_mesh(unit_square()), 1);
  EXPECT_EQ(exported.accessor("POSITION")["min"], Json::array({0.0, 0.0, 0.0}));
  EXPECT_EQ(exported.accessor("POSITION")["max"], Json::array({1.0, 0.0, 1.0}));
  EXPECT_FALSE(exported.accessor("NORMAL").contains("min"));
}

TEST(ExportMeshes, IndicesAreAsWideAsTheyMustBe) {
  // Cut n times a square has (2^n + 1)^2 vertices: 16641 and 66049.
  const ExportedPrimitive narrow = export_first(one_mesh(unit_square()), 7);
  EXPECT_EQ(narrow.document.json["accessors"][narrow.primitive["indices"].get<std::size_t>()]["componentType"], 5123);
  const ExportedPrimitive wide = export_first(one_mesh(unit_square()), 8);
  EXPECT_EQ(wide.document.json["accessors"][wide.primitive["indices"].get<std::size_t>()]["componentType"], 5125);
  const std::vector<std::uint32_t> indices = wide.indices();
  EXPECT_EQ(*std::max_element(indices.begin(), indices.end()), 66048U);
}

TEST(ExportMeshes, AStripBecomesTriangles) {
  PrimitiveParts parts = unit_square();
  parts.indices = {0, 1, 3, 2};
  parts.mode = 5;
  const ExportedPrimitive exported = export_first(one_mesh(parts), 1);
  EXPECT_EQ(exported.primitive["mode"], 4);
  EXPECT_EQ(exported.indices().size(), 24U);
  EXPECT_LT(glm::distance(area_vector(exported), glm::vec3(0, 1, 0)), 1e-6F);
}

TEST(ExportMeshes, APrimitiveWithoutIndicesGetsThem) {
  PrimitiveParts parts = unit_square();
  parts.indices.clear();
  parts.positions.pop_back(), parts.normals.pop_back(), parts.texcoords.pop_back();
  EXPECT_EQ(export_first(one_mesh(parts), 1).indices().size(), 12U);
}

TEST(ExportMeshes, MorphTargetsAreInterpolated) {
  GltfBuilder builder;
  Json primitive = builder.primitive(unit_square());
  const std::size_t deltas = builder.add_accessor(std::vector<glm::vec3>{{0, 0, 0}, {0, 2, 0}, {0, 4, 0}, {0, 6, 0}});
  primitive["targets"] = Json::array({Json{{"POSITION", deltas}, {"NORMAL", deltas}}});
  builder.add_node(builder.add_mesh(Json::array({primitive})));
  const ExportedPrimitive exported = export_first(builder, 1);
  for (const char* semantic : {"POSITION", "NORMAL"}) {
    const std::vector<float> values =
        as_floats(read_accessor(exported.document, exported.primitive["targets"][0][semantic].get<std::size_t>()));
    ASSERT_EQ(values.size(), 27U);
    // Linear for normals too: a difference has no unit length. The deltas are 6x + 2z - 4xz of the corners.
    const std::vector<glm::vec3> positions = exported.positions();
    const auto middle_of_left_edge = std::find(positions.begin(), positions.end(), glm::vec3(0.0F, 0.0F, 0.5F));
    ASSERT_NE(middle_of_left_edge, positions.end());
    EXPECT_FLOAT_EQ(values[static_cast<std::size_t>(middle_of_left_edge - positions.begin()) * 3 + 1], 1.0F);
  }
}

TEST(ExportMeshes, SparseSourcesAreWrittenWhole) {
  GltfBuilder builder;
  PrimitiveParts parts = unit_square();
  parts.texcoords.clear();
  Json primitive = builder.primitive(parts);
  const std::size_t base = builder.add_accessor(std::vector<glm::vec2>(4, glm::vec2(0.0F)));
  const Bytes index = {2}, value = encode_floats({0.5F, 0.25F}, ComponentType::kF32, false);
  builder.json["accessors"][base]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", builder.add_buffer_view(index)}, {"componentType", 5121}}},
      {"values", {{"bufferView", builder.add_buffer_view(value)}}}};
  primitive["attributes"]["TEXCOORD_0"] = base;
  builder.add_node(builder.add_mesh(Json::array({primitive})));
  const ExportedPrimitive exported = export_first(builder, 1);
  EXPECT_FALSE(exported.accessor("TEXCOORD_0").contains("sparse"));
  const std::vector<float> values = as_floats(exported.attribute("TEXCOORD_0"));
  EXPECT_EQ(values[4], 0.5F);
  EXPECT_EQ(values[5], 0.25F);
}

TEST(ExportMeshes, JointsAndWeightsAreMerged) {
  GltfBuilder builder;
  Json primitive = builder.primitive(unit_square());
  const Bytes joints = {0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0};
  primitive["attributes"]["JOINTS_0"] = builder.add_accessor(joints, 5121, "VEC4", 4);
  primitive["attributes"]["WEIGHTS_0"] = builder.add_accessor(std::vector<glm::vec4>(4, glm::vec4(1, 0, 0, 0)));
  builder.add_node(builder.add_mesh(Json::array({primitive})));
  const ExportedPrimitive exported = export_first(builder, 1);
  const std::vector<std::uint32_t> joint = as_indices(exported.attribute("JOINTS_0"));
  const std::vector<float> weight = as_floats(exported.attribute("WEIGHTS_0"));
  const std::vector<glm::vec3> positions = exported.positions();
  for (std::size_t v = 4; v < positions.size(); ++v) {  // joint 1 holds the far edge, z = 1
    if (positions[v].z != 0.5F) continue;
    EXPECT_EQ(joint[4 * v] + joint[4 * v + 1], 1U);
    EXPECT_EQ(weight[4 * v], 0.5F);
    EXPECT_EQ(weight[4 * v + 1], 0.5F);
  }
}

TEST(ExportMeshes, QuantizedPositionsKeepTheirType) {
  GltfBuilder builder;
  PrimitiveParts parts = unit_square();
  parts.positions.clear();
  Json primitive = builder.primitive(parts);
  const Bytes corners = encode_floats({0, 0, 0, 0, 0, 100, 100, 0, 100, 100, 0, 0}, ComponentType::kI16, false);
  Bytes rows;  // rows of three shorts are padded to eight bytes
  for (std::size_t v = 0; v < 4; ++v) {
    rows.insert(rows.end(), corners.begin() + static_cast<std::ptrdiff_t>(6 * v),
                corners.begin() + static_cast<std::ptrdiff_t>(6 * v + 6));
    rows.insert(rows.end(), {0, 0});
  }
  const std::size_t accessor = builder.add_accessor(rows, 5122, "VEC3", 4);
  builder.json["bufferViews"][builder.json["accessors"][accessor]["bufferView"].get<std::size_t>()]["byteStride"] = 8;
  builder.json["extensionsUsed"] = Json::array({"KHR_mesh_quantization"});
  primitive["attributes"]["POSITION"] = accessor;
  builder.add_node(builder.add_mesh(Json::array({primitive})));
  const ExportedPrimitive exported = export_first(builder, 1);
  EXPECT_EQ(exported.attribute("POSITION").component, ComponentType::kI16);
  EXPECT_EQ(exported.accessor("POSITION")["max"], Json::array({100, 0, 100}));
  EXPECT_THAT(exported.positions(), testing::Contains(glm::vec3(50, 0, 50)));
}

TEST(ExportMeshes, ColorsAreLeftToTheirOwnExporter) {
  PrimitiveParts parts = unit_square();
  parts.colors.assign(4, glm::vec4(1.0F));
  const GltfBuilder builder = one_mesh(parts);
  const ExportedPrimitive exported = export_first(builder, 1);
  EXPECT_EQ(exported.primitive["attributes"]["COLOR_0"],
            builder.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"]);
}

TEST(ExportMeshes, VerticesSplitForFlatShadingRepeatTheirSource) {
  PrimitiveParts parts = unit_square();
  const HandBake hand = bake_by_hand(one_mesh(parts), 0, kLight);
  PrimitiveInstance instance = hand.scene.instances[0];
  instance.source_vertex = {0, 1, 2, 0, 2, 3};
  RefinedPrimitive refined;
  refined.changed = true;
  refined.vertices = {0, 1, 2, 3, 4, 5};
  refined.triangles = {{0, 1, 2}, {3, 4, 5}};
  Document document = hand.document;
  BufferBuilder added;
  Json primitive = document.json["meshes"][0]["primitives"][0];
  export_geometry(document, added, instance, refined, primitive);
  document.buffers.push_back(added.bytes());
  const ExportedPrimitive exported{document, primitive};
  EXPECT_EQ(exported.positions()[3], parts.positions[0]);
  EXPECT_EQ(exported.positions()[5], parts.positions[3]);
  EXPECT_THAT(exported.indices(), testing::ElementsAre(0, 1, 2, 3, 4, 5));
}

TEST(ExportMeshes, OneAccessorUsedTwiceStaysOne) {
  GltfBuilder builder;
  Json primitive = builder.primitive(unit_square());
  primitive["attributes"]["TEXCOORD_1"] = primitive["attributes"]["TEXCOORD_0"];
  builder.add_node(builder.add_mesh(Json::array({primitive})));
  const ExportedPrimitive exported = export_first(builder, 1);
  EXPECT_EQ(exported.primitive["attributes"]["TEXCOORD_1"], exported.primitive["attributes"]["TEXCOORD_0"]);
}

}  // namespace
}  // namespace gltf_radiosity
