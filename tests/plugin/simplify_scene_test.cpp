#include "plugin/simplify_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "plugin/export_scene.h"
#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

/// A square of `n` x `n` quads in the plane y = 0.
PrimitiveParts tessellated_square(int n) {
  PrimitiveParts parts;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const float x = static_cast<float>(i) / static_cast<float>(n), z = static_cast<float>(j) / static_cast<float>(n);
      parts.positions.emplace_back(x, 0.0F, z);
      parts.normals.emplace_back(0.0F, 1.0F, 0.0F);
      parts.texcoords.emplace_back(4.0F * x, 1.0F - z);
      if (i == n || j == n) continue;
      const auto a = static_cast<std::uint32_t>(j * (n + 1) + i), b = a + 1, c = a + static_cast<std::uint32_t>(n) + 1,
                 d = c + 1;
      for (const std::uint32_t corner : {a, d, b, a, c, d}) parts.indices.push_back(corner);
    }
  }
  return parts;
}

struct Thinned {
  Document document;
  ExportReport report;
  std::vector<Warning> warnings;

  const Json& primitive(std::size_t mesh) const { return document.json["meshes"][mesh]["primitives"][0]; }
  std::size_t count(std::size_t mesh, const std::string& semantic) const {
    const auto accessor = primitive(mesh)["attributes"][semantic].get<std::size_t>();
    return document.json["accessors"][accessor]["count"].get<std::size_t>();
  }
  RawAccessor rows(std::size_t mesh, const std::string& semantic) const {
    return read_accessor(document, primitive(mesh)["attributes"][semantic].get<std::size_t>());
  }
};

/// Under the same light everywhere.
Thinned thinned(const GltfBuilder& builder, int levels = 0, Options options = {}) {
  options.simplify = true;
  HandBake hand = bake_by_hand(builder, levels, radiosity::Rgb(1.0F), options);
  Thinned result;
  result.report = export_scene(hand.document, hand.added, hand.scene, hand.bake, options, result.warnings, {});
  result.document = read_back(hand.document, hand.added);
  return result;
}

/// How many vertices a square of 4 x 4 quads has once `change` was made to its primitive.
template <typename Change>
std::size_t thinned_count(const Change& change) {
  GltfBuilder builder;
  PrimitiveParts parts = tessellated_square(4);
  Json primitive = builder.primitive(parts);
  change(builder, primitive);
  builder.add_node(builder.add_mesh(Json::array({primitive})));
  return thinned(builder).count(0, "POSITION");
}

std::size_t add_float_scalars(GltfBuilder& builder, const std::vector<float>& values) {
  Bytes bytes(values.size() * sizeof(float));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return builder.add_accessor(bytes, 5126, "SCALAR", values.size());
}

TEST(SimplifyScene, WhatStaysKeepsItsBytes) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(tessellated_square(8)));
  const Thinned result = thinned(builder);
  EXPECT_EQ(result.report.vertices, 4U);
  EXPECT_EQ(result.report.triangles, 2U);
  EXPECT_EQ(result.report.simplified.removed_vertices, 77U);
  EXPECT_LT(result.report.simplified.light_change, 1e-6);
  EXPECT_THAT(as_floats(result.rows(0, "POSITION")), testing::ElementsAre(0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 1));
  EXPECT_THAT(as_floats(result.rows(0, "TEXCOORD_0")), testing::ElementsAre(0, 1, 4, 1, 0, 0, 4, 0));
  EXPECT_EQ(result.count(0, "NORMAL"), 4U);
  EXPECT_EQ(result.count(0, "COLOR_0"), 4U);
  const auto indices = as_indices(read_accessor(result.document, result.primitive(0)["indices"].get<std::size_t>()));
  EXPECT_EQ(indices.size(), 6U);
  EXPECT_EQ(*std::ranges::max_element(indices), 3U);
}

TEST(SimplifyScene, TakesBackWhatWasCutForNothing) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(unit_square()));
  const Thinned result = thinned(builder, 3);
  EXPECT_EQ(result.report.vertices, 4U);
  EXPECT_EQ(result.report.simplified.removed_vertices, 77U);
}

TEST(SimplifyScene, EveryAttributeHasASay) {
  const auto bent = [](const std::string& semantic) {
    return thinned_count([&](GltfBuilder& builder, Json& primitive) {
      std::vector<float> values(25, 0.0F);
      values[12] = 1.0F;
      primitive["attributes"][semantic] = add_float_scalars(builder, values);
    });
  };
  EXPECT_EQ(thinned_count([](GltfBuilder&, Json&) {}), 4U);
  EXPECT_GT(bent("_HEAT"), 4U);
  EXPECT_GT(thinned_count([](GltfBuilder& builder, Json& primitive) {
              std::vector<glm::vec2> uv(25);
              for (std::size_t v = 0; v < uv.size(); ++v) uv[v].x = static_cast<float>(v % 5 * (v % 5));
              primitive["attributes"]["TEXCOORD_1"] = builder.add_accessor(uv);
            }),
            9U);
  EXPECT_GT(thinned_count([](GltfBuilder& builder, Json& primitive) {
              std::vector<glm::vec4> colors(25, glm::vec4(1.0F));
              colors[12] = {0.5F, 0.5F, 0.5F, 1.0F};
              primitive["attributes"]["COLOR_0"] = builder.add_accessor(colors);
            }),
            4U);
}

TEST(SimplifyScene, LinearValuesNeedNoVertices) {
  EXPECT_EQ(thinned_count([](GltfBuilder& builder, Json& primitive) {
              std::vector<float> values(25);
              for (std::size_t v = 0; v < values.size(); ++v) values[v] = 100.0F * static_cast<float>(v % 5);
              primitive["attributes"]["_HEAT"] = add_float_scalars(builder, values);
            }),
            4U);
}

TEST(SimplifyScene, MorphTargetsHaveASay) {
  EXPECT_GT(thinned_count([](GltfBuilder& builder, Json& primitive) {
              std::vector<glm::vec3> moved(25, glm::vec3(0.0F));
              moved[12].y = 1.0F;
              primitive["targets"] = Json::array({{{"POSITION", builder.add_accessor(moved)}}});
            }),
            4U);
}

TEST(SimplifyScene, JointsAreLabelsAndTheirWeightsValues) {
  const auto skinned = [](const auto& second_weight) {
    return thinned_count([&](GltfBuilder& builder, Json& primitive) {
      Bytes joints;
      std::vector<glm::vec4> weights;
      for (std::size_t v = 0; v < 25; ++v) {
        const float second = second_weight(static_cast<float>(v % 5) / 4.0F);
        // The stronger joint first, as exporters like it.
        const std::uint8_t stronger = second > 0.5F ? 1 : 0;
        joints.insert(joints.end(), {stronger, static_cast<std::uint8_t>(1 - stronger), 0, 0});
        weights.emplace_back(std::max(second, 1.0F - second), std::min(second, 1.0F - second), 0.0F, 0.0F);
      }
      primitive["attributes"]["JOINTS_0"] = builder.add_accessor(joints, 5121, "VEC4", 25);
      primitive["attributes"]["WEIGHTS_0"] = builder.add_accessor(weights);
    });
  };
  EXPECT_EQ(skinned([](float x) { return 0.1F + 0.8F * x; }), 4U);
  EXPECT_GT(skinned([](float x) { return x < 0.5F ? 0.1F : 0.9F; }), 4U);
  EXPECT_GT(skinned([](float x) { return x < 0.6F ? 0.0F : 1.0F; }), 8U) << "other joints";
}

TEST(SimplifyScene, WhatReceivesNoLightStays) {
  GltfBuilder builder;
  PrimitiveParts parts = tessellated_square(4);
  builder.add_node(builder.add_mesh(parts));
  parts.material = builder.add_material({{"extensions", {{"KHR_materials_unlit", Json::object()}}}});
  builder.json["extensionsUsed"] = {"KHR_materials_unlit"};
  builder.add_node(builder.add_mesh(parts), {{"translation", {0.0, 0.0, 1.0}}});
  const Thinned result = thinned(builder);
  EXPECT_EQ(result.count(1, "POSITION"), 25U);
  EXPECT_EQ(result.count(0, "POSITION"), 7U) << "and keeps the vertices on the line to its neighbour";
}

TEST(SimplifyScene, WhatIsNotSelectedStays) {
  GltfBuilder builder;
  const std::size_t mesh = builder.add_mesh(tessellated_square(4));
  builder.add_node(mesh, {{"name", "lit"}});
  builder.add_node(mesh, {{"name", "left"}, {"translation", {0.0, 0.0, 1.0}}});
  Options options;
  options.select = {"lit"};
  const Thinned result = thinned(builder, 0, options);
  const std::size_t lit = result.document.json["nodes"][0]["mesh"].get<std::size_t>();
  EXPECT_EQ(result.count(lit, "POSITION"), 7U) << "the vertices on the line to its neighbour stay as well";
  EXPECT_EQ(result.count(result.document.json["nodes"][1]["mesh"].get<std::size_t>(), "POSITION"), 25U);
}

TEST(SimplifyScene, VerticesThatAnExtensionMayNameStay) {
  GltfBuilder builder;
  Json primitive = builder.primitive(tessellated_square(4));
  primitive["extensions"]["VENDOR_edges"] = {{"vertices", {1, 2}}};
  builder.json["extensionsUsed"] = {"VENDOR_edges"};
  builder.add_node(builder.add_mesh(Json::array({primitive})));
  const Thinned result = thinned(builder);
  EXPECT_EQ(result.count(0, "POSITION"), 25U);
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_EQ(result.warnings[0].code, "not-simplified");
}

TEST(SimplifyScene, LightBeyondWhiteHasASayWhereItIsStored) {
  GltfBuilder builder;
  PrimitiveParts parts = tessellated_square(4);
  parts.colors.assign(25, glm::vec4(1.0F));
  parts.colors[12] = {0.5F, 0.5F, 0.5F, 1.0F};
  builder.add_node(builder.add_mesh(parts));
  Options options;
  options.exposure = 100.0;
  EXPECT_EQ(thinned(builder, 0, options).count(0, "POSITION"), 4U) << "everything is white";
  options.radiance_attribute = "_LIGHT";
  const Thinned bright = thinned(builder, 0, options);
  EXPECT_GT(bright.count(0, "POSITION"), 4U);
  EXPECT_EQ(bright.count(0, "_LIGHT"), bright.count(0, "POSITION"));
}

TEST(SimplifyScene, ASecondInstanceIsSimplifiedOnItsOwn) {
  GltfBuilder builder;
  const std::size_t mesh = builder.add_mesh(tessellated_square(4));
  builder.add_node(mesh);
  builder.add_node(mesh, {{"scale", {-1.0, 1.0, 1.0}}});
  const Thinned result = thinned(builder);
  EXPECT_EQ(result.report.vertices, 8U);
  EXPECT_EQ(result.report.triangles, 4U);
}

}  // namespace
}  // namespace gltf_radiosity
