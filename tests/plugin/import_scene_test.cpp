#include "plugin/import_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "core/mesh/subdivide_uniform.h"
#include "tests/plugin/gltf_builder.h"

namespace gltf_radiosity {
namespace {

using radiosity::Rgb;

constexpr float kRounding = 1e-5F;

struct Imported {
  ImportedScene imported;
  std::vector<Warning> warnings;

  const radiosity::Scene& scene() const { return imported.scene; }
  bool warned(const std::string& code) const {
    return std::any_of(warnings.begin(), warnings.end(), [&](const Warning& warning) { return warning.code == code; });
  }
};

Imported import(const GltfBuilder& builder, const Options& options = {}) {
  Imported result;
  const auto document = read_document(builder.glb(), {});
  EXPECT_TRUE(document) << document.error().text();
  if (!document) return result;
  auto scene = import_scene(*document, options, result.warnings);
  EXPECT_TRUE(scene) << scene.error().text();
  if (!scene) return result;
  result.imported = std::move(*scene);
  EXPECT_EQ(radiosity::validate(result.scene()), std::nullopt);
  return result;
}

std::string verdict(const GltfBuilder& builder, const Options& options = {}) {
  const auto document = read_document(builder.glb(), {});
  if (!document) return document.error().text();
  std::vector<Warning> warnings;
  const auto scene = import_scene(*document, options, warnings);
  return scene ? "fine" : scene.error().text();
}

GltfBuilder square_with(const Json& material) {
  GltfBuilder builder;
  PrimitiveParts parts = unit_square();
  parts.material = builder.add_material(material);
  builder.add_node(builder.add_mesh(parts));
  return builder;
}

// Hierarchy.

TEST(ImportScene, TransformsAreAppliedFromTheRootDown) {
  GltfBuilder builder;
  const double half = std::numbers::sqrt2 / 2;
  const std::size_t root =
      builder.add_node(std::nullopt, {{"translation", {10.0, 0.0, 0.0}}, {"rotation", {0.0, half, 0.0, half}}});
  builder.add_node(builder.add_mesh(unit_square()), {{"scale", {2.0, 1.0, 1.0}}}, root);
  const Imported result = import(builder);
  // (1, 0, 0) is scaled to (2, 0, 0), turned about y to (0, 0, -2) and moved.
  EXPECT_NEAR(glm::distance(result.scene().positions[3], glm::vec3(10, 0, -2)), 0.0F, kRounding);
  EXPECT_EQ(result.imported.instances[0].node, 1U);
}

TEST(ImportScene, MatricesAreColumnMajor) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(unit_square()), {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}});
  EXPECT_EQ(import(builder).scene().positions[0], glm::vec3(5, 6, 7));
}

TEST(ImportScene, NormalsTurnWithTheInverseTranspose) {
  GltfBuilder builder;
  PrimitiveParts parts = unit_square();
  const float half = std::numbers::sqrt2_v<float> / 2;
  for (glm::vec3& normal : parts.normals) normal = {half, half, 0};
  builder.add_node(builder.add_mesh(parts), {{"scale", {2.0, 1.0, 1.0}}});
  const glm::vec3 normal = import(builder).scene().normals[0];
  EXPECT_NEAR(glm::distance(normal, glm::normalize(glm::vec3(0.5F, 1.0F, 0.0F))), 0.0F, kRounding);
}

TEST(ImportScene, AMirroredInstanceIsTurnedBack) {
  GltfBuilder builder;
  const std::size_t mesh = builder.add_mesh(unit_square());
  builder.add_node(mesh);
  builder.add_node(mesh, {{"scale", {-1.0, 1.0, 1.0}}});
  const Imported result = import(builder);
  EXPECT_FALSE(result.imported.instances[0].mirrored);
  EXPECT_TRUE(result.imported.instances[1].mirrored);
  for (std::uint32_t triangle = 0; triangle < 4; ++triangle) {
    EXPECT_GT(radiosity::scaled_normal(result.scene(), triangle).y, 0.0F) << "the front stays up";
  }
  EXPECT_EQ(result.scene().normals[4], glm::vec3(0, 1, 0));
}

TEST(ImportScene, InstancesTileTheScene) {
  GltfBuilder builder;
  const std::size_t mesh =
      builder.add_mesh(Json::array({builder.primitive(unit_square()), builder.primitive(unit_square())}));
  builder.add_node(mesh);
  builder.add_node(mesh, {{"translation", {0.0, 3.0, 0.0}}});
  const Imported result = import(builder);
  ASSERT_EQ(result.imported.instances.size(), 4U);
  std::uint32_t vertex = 0, triangle = 0;
  for (const PrimitiveInstance& instance : result.imported.instances) {
    EXPECT_EQ(instance.first_vertex, vertex);
    EXPECT_EQ(instance.first_triangle, triangle);
    vertex += instance.vertex_count;
    triangle += instance.triangle_count;
  }
  EXPECT_EQ(vertex, result.scene().positions.size());
  EXPECT_EQ(triangle, result.scene().triangles.size());
  EXPECT_EQ(result.imported.vertex_colors.size(), vertex * 4);
  EXPECT_EQ(result.imported.level_of_triangle.size(), triangle);
}

TEST(ImportScene, DeepHierarchiesAreNoProblem) {
  GltfBuilder builder;
  std::size_t node = builder.add_node(std::nullopt);
  for (int i = 0; i < 10000; ++i) node = builder.add_node(std::nullopt, {{"translation", {0.001, 0.0, 0.0}}}, node);
  builder.add_node(builder.add_mesh(unit_square()), Json::object(), node);
  EXPECT_NEAR(import(builder).scene().positions[0].x, 10.0F, 1e-4F);
}

TEST(ImportScene, OnlyTheDefaultSceneIsWalked) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(unit_square()));
  builder.json["nodes"].push_back({{"mesh", 0}});
  builder.json["scenes"].push_back({{"nodes", {1}}});
  builder.json["scene"] = 1;
  const Imported result = import(builder);
  ASSERT_EQ(result.imported.instances.size(), 1U);
  EXPECT_EQ(result.imported.instances[0].node, 1U);
  builder.json.erase("scene");
  EXPECT_EQ(import(builder).imported.instances[0].node, 0U);
  builder.json.erase("scenes");
  EXPECT_EQ(import(builder).imported.instances.size(), 2U) << "without scenes every root counts";
}

TEST(ImportScene, WhatANodeMovesToInfinityIsNamed) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(unit_square()), {{"scale", {1e38, 1.0, 1.0}}, {"translation", {3e38, 0.0, 0.0}}});
  EXPECT_EQ(verdict(builder), "nodes[0]: its vertices lie beyond 1e8 m");
}

// Found by fuzz_bake: squared areas became infinite, and a ray that was not a number ended the program in Embree.
TEST(ImportScene, AVertexTooFarAwayForAreasToBeFiniteIsNamed) {
  GltfBuilder builder;
  PrimitiveParts parts = unit_square();
  parts.positions[2].y = 1e19F;
  builder.add_node(builder.add_mesh(parts));
  EXPECT_EQ(verdict(builder), "nodes[0]: its vertices lie beyond 1e8 m");
}

TEST(ImportScene, ALightTooFarAwayForDistancesToBeFiniteIsNamed) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(unit_square()));
  builder.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({{{"type", "point"}}});
  const Json light = {{"KHR_lights_punctual", {{"light", 0}}}};
  builder.add_node(std::nullopt, {{"translation", {1e20, 0.0, 0.0}}, {"extensions", light}});
  EXPECT_EQ(verdict(builder), "nodes[1]: its light lies beyond 1e8 m");
}

// Primitives.

TEST(ImportScene, StripsAndFansKeepTheirFront) {
  PrimitiveParts strip = unit_square();
  strip.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 0, 1}, {2, 0, 0}};
  strip.normals.assign(5, {0, 1, 0});
  strip.texcoords.clear();
  strip.indices.clear();
  strip.mode = 5;
  PrimitiveParts fan = unit_square();
  fan.indices = {0, 1, 2, 3};
  fan.mode = 6;
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(strip));
  builder.add_node(builder.add_mesh(fan));
  const Imported result = import(builder);
  ASSERT_EQ(result.scene().triangles.size(), 5U);
  float area = 0;
  for (std::uint32_t triangle = 0; triangle < 5; ++triangle) {
    EXPECT_GT(radiosity::scaled_normal(result.scene(), triangle).y, 0.0F) << triangle;
    area += radiosity::scaled_normal(result.scene(), triangle).y / 2;
  }
  EXPECT_FLOAT_EQ(area, 1.5F + 1.0F);
}

TEST(ImportScene, PointsAndLinesAreSkipped) {
  GltfBuilder builder;
  PrimitiveParts lines = unit_square();
  lines.mode = 1;
  builder.add_node(builder.add_mesh(Json::array({builder.primitive(lines), builder.primitive(unit_square())})));
  const Imported result = import(builder);
  ASSERT_EQ(result.imported.instances.size(), 1U);
  EXPECT_EQ(result.imported.instances[0].primitive, 1U);
  EXPECT_TRUE(result.warned("points-and-lines"));
}

TEST(ImportScene, BadIndicesAndPositionsAreNamed) {
  GltfBuilder builder;
  PrimitiveParts parts = unit_square();
  parts.indices[4] = 17;
  builder.add_node(builder.add_mesh(parts));
  EXPECT_EQ(verdict(builder), "meshes[0].primitives[0]: index 17 is beyond 4 vertices");
  GltfBuilder wild;
  parts = unit_square();
  parts.positions[2].y = std::numeric_limits<float>::quiet_NaN();
  wild.add_node(wild.add_mesh(parts));
  EXPECT_EQ(verdict(wild), "meshes[0].primitives[0]: the position of vertex 2 is not finite");
}

TEST(ImportScene, BrokenNormalsAreRecomputedAndCounted) {
  GltfBuilder builder;
  PrimitiveParts parts = unit_square();
  parts.normals[0] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
  parts.normals[1] = glm::vec3(0.0F);
  builder.add_node(builder.add_mesh(parts));
  const Imported result = import(builder);
  EXPECT_EQ(result.scene().normals[0], glm::vec3(0, 1, 0));
  EXPECT_EQ(result.scene().normals[1], glm::vec3(0, 1, 0));
  ASSERT_TRUE(result.warned("bad-normals"));
  EXPECT_THAT(result.warnings.back().message, testing::StartsWith("2 normals"));
  EXPECT_EQ(result.warnings.back().place, "meshes[0].primitives[0]");
}

TEST(ImportScene, WithoutNormalsACubeIsSplitAlongItsEdges) {
  GltfBuilder builder;
  PrimitiveParts cube;
  for (int i = 0; i < 8; ++i) cube.positions.emplace_back(i & 1, (i >> 1) & 1, (i >> 2) & 1);
  cube.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                  2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  builder.add_node(builder.add_mesh(cube));
  const Imported result = import(builder);
  EXPECT_EQ(result.scene().positions.size(), 24U);
  const std::vector<std::uint32_t>& source = result.imported.instances[0].source_vertex;
  ASSERT_EQ(source.size(), 24U);
  for (std::size_t v = 0; v < 24; ++v) EXPECT_EQ(result.scene().positions[v], cube.positions[source[v]]);
  EXPECT_EQ(result.scene().normals[0], glm::vec3(0.0F)) << "flat";
}

TEST(ImportScene, WithoutNormalsAFlatSquareStaysWhole) {
  GltfBuilder builder;
  PrimitiveParts parts = unit_square();
  parts.normals.clear();
  builder.add_node(builder.add_mesh(parts));
  const Imported result = import(builder);
  EXPECT_EQ(result.scene().positions.size(), 4U);
  EXPECT_TRUE(result.imported.instances[0].source_vertex.empty());
}

TEST(ImportScene, TheRestPoseFollowsSkinsAndMorphTargets) {
  GltfBuilder builder;
  Json primitive = builder.primitive(unit_square());
  const std::vector<std::uint8_t> joints(16, 0);
  primitive["attributes"]["JOINTS_0"] = builder.add_accessor(joints, 5121, "VEC4", 4);
  primitive["attributes"]["WEIGHTS_0"] = builder.add_accessor(std::vector<glm::vec4>(4, {1, 0, 0, 0}));
  primitive["targets"] = Json::array({Json{{"POSITION", builder.add_accessor(std::vector<glm::vec3>(4, {0, 2, 0}))}}});
  const std::size_t mesh = builder.add_mesh(Json::array({primitive}));
  builder.json["meshes"][mesh]["weights"] = {0.5};
  const std::size_t joint = builder.add_node(std::nullopt, {{"translation", {0.0, 0.0, 7.0}}});
  builder.json["skins"] = Json::array({Json{{"joints", {joint}}}});
  builder.add_node(mesh, {{"skin", 0}, {"translation", {100.0, 0.0, 0.0}}});
  const Imported result = import(builder);
  EXPECT_EQ(result.scene().positions[0], glm::vec3(0, 1, 7)) << "a skin ignores its node's own transform";
  EXPECT_TRUE(result.warned("rest-pose"));
}

// Materials.

TEST(ImportScene, ConstantSurfacesNeedNoDetail) {
  const Imported result = import(
      square_with({{"pbrMetallicRoughness", {{"baseColorFactor", {0.2, 0.4, 0.6, 1.0}}}}, {"doubleSided", true}}));
  const radiosity::Surface& surface = result.scene().surfaces[0];
  EXPECT_FALSE(surface.varies);
  EXPECT_FALSE(surface.see_through);
  EXPECT_TRUE(surface.two_sided);
  EXPECT_EQ(surface.reflectance, Rgb(0.2F, 0.4F, 0.6F));
}

TEST(ImportScene, VertexColorsMultiplyOnlyWhereTheyAre) {
  GltfBuilder builder;
  PrimitiveParts plain = unit_square(), colored = unit_square();
  plain.material = colored.material =
      builder.add_material({{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 1.0}}}}});
  colored.colors = {{1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}};
  builder.add_node(builder.add_mesh(Json::array({builder.primitive(plain), builder.primitive(colored)})));
  const Imported result = import(builder);
  EXPECT_FALSE(result.scene().surfaces[result.scene().surface_of_triangle[0]].varies);
  EXPECT_EQ(radiosity::mean_reflectance(result.scene(), 2, {}), Rgb(0.5F, 0.0F, 0.0F));
  const Rgb mixed = radiosity::mean_reflectance(result.scene(), 3, {});
  EXPECT_NEAR(mixed.x, 0.5F * 2 / 3, kRounding);
  EXPECT_NEAR(mixed.y, 0.5F * 1 / 3, kRounding);
  EXPECT_EQ(result.imported.vertex_colors[0], 1.0F) << "ones where there is no COLOR_0";
  EXPECT_EQ(result.imported.vertex_colors[(4 + 3) * 4], 0.0F);
}

TEST(ImportScene, TexturesAreAveragedOverEachPart) {
  GltfBuilder builder;
  const std::size_t texture = builder.add_texture(2, 1, {0, 0, 0, 255, 255, 255, 255, 255});
  PrimitiveParts parts = unit_square();
  parts.material =
      builder.add_material({{"pbrMetallicRoughness",
                             {{"baseColorTexture", {{"index", texture}}}, {"baseColorFactor", {0.5, 0.5, 0.5, 1.0}}}}});
  builder.add_node(builder.add_mesh(parts));
  const Imported result = import(builder);
  // Triangle 0 is (0,0) (0,1) (1,1) in the texture: a quarter of it lies in the white half.
  EXPECT_NEAR(radiosity::mean_reflectance(result.scene(), 0, {}).x, 0.5F * 0.25F, 1e-4F);
  const radiosity::SubTriangle corner = {{{0.0F, 0.8F}, {0.2F, 0.8F}, {0.0F, 1.0F}}};
  EXPECT_NEAR(radiosity::mean_reflectance(result.scene(), 0, corner).x, 0.5F, 1e-4F);
  EXPECT_NEAR(mean_base_color_texture(result.imported, 0, 0, {}).x, 0.25F, 1e-4F) << "without the factor";
}

TEST(ImportScene, EmissionIsFactorTimesStrengthTimesTexture) {
  GltfBuilder builder;
  const std::size_t texture = builder.add_texture(2, 1, {0, 0, 0, 255, 255, 255, 255, 255});
  PrimitiveParts parts = unit_square();
  parts.material =
      builder.add_material({{"emissiveFactor", {1.0, 0.5, 0.0}},
                            {"emissiveTexture", {{"index", texture}}},
                            {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8.0}}}}}});
  builder.add_node(builder.add_mesh(parts));
  const Imported result = import(builder);
  const Rgb emission = radiosity::mean_emission(result.scene(), 0, {});
  EXPECT_NEAR(emission.x, 2.0F, 1e-3F);
  EXPECT_NEAR(emission.y, 1.0F, 1e-3F);
  EXPECT_EQ(result.imported.emissive_triangle_count, 2U);
  EXPECT_FALSE(result.warned("default-sky"));
}

TEST(ImportScene, AMaskIsOpaqueOrNotAndBlendingIsInBetween) {
  const auto opacity = [](const char* mode, double alpha) {
    const Imported result =
        import(square_with({{"alphaMode", mode}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, alpha}}}}}));
    const radiosity::Surface& surface = result.scene().surfaces[0];
    return surface.see_through ? result.scene().detail->opacity(0, {0.2F, 0.2F}) : 1.0F;
  };
  EXPECT_EQ(opacity("MASK", 0.4), 0.0F);
  EXPECT_EQ(opacity("MASK", 0.6), 1.0F);
  EXPECT_FLOAT_EQ(opacity("BLEND", 0.4), 0.4F);
  EXPECT_EQ(opacity("OPAQUE", 0.4), 1.0F);
  EXPECT_FALSE(import(square_with({{"alphaMode", "BLEND"}})).scene().surfaces[0].see_through);
}

TEST(ImportScene, MetalsAreDiffuseOrBlack) {
  const GltfBuilder builder =
      square_with({{"pbrMetallicRoughness", {{"baseColorFactor", {0.8, 0.8, 0.8, 1}}, {"metallicFactor", 0.75}}}});
  EXPECT_FLOAT_EQ(import(builder).scene().surfaces[0].reflectance.x, 0.8F);
  Options options;
  options.metals = Metals::kBlack;
  EXPECT_FLOAT_EQ(import(builder, options).scene().surfaces[0].reflectance.x, 0.2F);
}

TEST(ImportScene, UnlitMaterialsOnlyBlock) {
  GltfBuilder builder =
      square_with({{"emissiveFactor", {1, 1, 1}}, {"extensions", {{"KHR_materials_unlit", Json::object()}}}});
  EXPECT_EQ(verdict(builder), "nothing to bake: every material of the scene is unlit or clear");
  builder.add_node(builder.add_mesh(unit_square()));
  const Imported result = import(builder);
  EXPECT_FALSE(result.imported.instances[0].receives);
  EXPECT_TRUE(result.imported.instances[1].receives);
  EXPECT_EQ(radiosity::mean_reflectance(result.scene(), 0, {}), Rgb(0.0F));
  EXPECT_EQ(radiosity::mean_emission(result.scene(), 0, {}), Rgb(0.0F));
}

// Light.

TEST(ImportScene, WithoutAnyLightTheSkyIsWhiteAndSaysSo) {
  GltfBuilder builder = square_with({{"name", "plain"}});
  Imported result = import(builder);
  EXPECT_EQ(result.scene().sky.luminance, Rgb(1.0F));
  EXPECT_TRUE(result.warned("default-sky"));

  builder.add_light({{"type", "point"}, {"intensity", 0.0}});
  EXPECT_TRUE(import(builder).warned("default-sky")) << "a light that is off does not count";
  builder.add_light({{"type", "point"}, {"intensity", 5.0}});
  result = import(builder);
  EXPECT_EQ(result.scene().sky.luminance, Rgb(0.0F));
  EXPECT_EQ(result.imported.punctual_light_count, 2U);
}

TEST(ImportScene, OptionsSetSkyAndSun) {
  const GltfBuilder builder = square_with({{"name", "plain"}});
  Options options;
  options.default_sky = false;
  EXPECT_EQ(import(builder, options).scene().sky.luminance, Rgb(0.0F));
  options.default_sky = true;
  options.sky = {0.1, 0.2, 0.3};
  EXPECT_EQ(import(builder, options).scene().sky.luminance, Rgb(0.1F, 0.2F, 0.3F));
  options.sky.reset();
  options.sun = Sun{90.0, 0.0, 1000.0};
  const Imported result = import(builder, options);
  ASSERT_EQ(result.scene().lights.size(), 1U);
  EXPECT_EQ(result.scene().sky.luminance, Rgb(0.0F));
  EXPECT_EQ(result.imported.punctual_light_count, 0U);
  options.sky = {-1.0, 0.0, 0.0};
  EXPECT_EQ(verdict(builder, options), "sky: is negative or not finite");
}

// Subdivision.

TEST(ImportScene, TheNearestLevelAboveANodeCountsAndOptionsWin) {
  GltfBuilder builder;
  const std::size_t mesh = builder.add_mesh(unit_square());
  builder.add_node(mesh, {{"name", "free"}});
  const std::size_t root = builder.add_node(mesh, {{"name", "root"}, {"extras", {{"radiosity", {{"subdivide", 2}}}}}});
  const std::size_t child =
      builder.add_node(mesh, {{"name", "child"}, {"extras", {{"radiosity", {{"subdivide", 4}}}}}}, root);
  builder.add_node(mesh, {{"name", "grandchild"}}, child);
  const auto levels = [&](const Options& options) {
    const Imported result = import(builder, options);
    std::vector<int> found;
    for (const PrimitiveInstance& instance : result.imported.instances) {
      found.push_back(result.imported.level_of_triangle[instance.first_triangle]);
    }
    return found;
  };
  const int automatic = radiosity::kLevelFromPatchSize;
  EXPECT_EQ(levels({}), (std::vector<int>{automatic, 2, 4, 4}));
  Options options;
  options.subdivide = {{"root", 1}, {"child", 3}};
  EXPECT_EQ(levels(options), (std::vector<int>{automatic, 1, 3, 3}));
  options.subdivide = {{"nobody", 1}};
  EXPECT_EQ(verdict(builder, options), "subdivide: no node of the scene is called \"nobody\"");
}

TEST(ImportScene, SenselessLevelsAreIgnoredWithAWarning) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(unit_square()), {{"extras", {{"radiosity", {{"subdivide", 99}}}}}});
  const Imported result = import(builder);
  EXPECT_TRUE(result.warned("bad-subdivide"));
  EXPECT_EQ(result.imported.level_of_triangle[0], radiosity::kLevelFromPatchSize);
}

// Scenes and visibility.

TEST(ImportScene, AnySceneOfTheFileCanBeChosen) {
  GltfBuilder builder;
  const std::size_t mesh = builder.add_mesh(unit_square());
  builder.add_node(mesh, {{"translation", {1, 0, 0}}});
  builder.add_node(mesh, {{"translation", {2, 0, 0}}});
  builder.json["scenes"] = Json::parse(R"([{"nodes": [0]}, {"nodes": [1]}])");
  const auto first_x = [&](std::optional<std::uint32_t> scene) {
    Options options;
    options.scene = scene;
    return import(builder, options).scene().positions[0].x;
  };
  EXPECT_EQ(first_x(std::nullopt), 1.0F);
  EXPECT_EQ(first_x(0), 1.0F);
  EXPECT_EQ(first_x(1), 2.0F);
  builder.json["scene"] = 1;
  EXPECT_EQ(first_x(std::nullopt), 2.0F);
  builder.json.erase("scene");
  EXPECT_EQ(first_x(std::nullopt), 1.0F);
  Options options;
  options.scene = 2;
  EXPECT_EQ(verdict(builder, options), "--scene: there is no scene 2: the file has 2, counted from 0");
}

TEST(ImportScene, WhatIsInvisibleTakesNoPart) {
  GltfBuilder builder;
  const std::size_t mesh = builder.add_mesh(unit_square());
  const Json hidden = Json::parse(R"({"KHR_node_visibility": {"visible": false}})");
  const Json shown = Json::parse(R"({"KHR_node_visibility": {"visible": true}})");
  builder.add_node(mesh, {{"extensions", shown}});
  const std::size_t parent = builder.add_node(mesh, {{"extensions", hidden}});
  builder.add_node(mesh, {{"extensions", shown}}, parent);  // an ancestor hides it
  Json lamp = hidden;
  lamp["KHR_lights_punctual"]["light"] = 0;
  builder.add_light({{"type", "point"}}, {{"extensions", lamp}});
  const Imported result = import(builder);
  ASSERT_EQ(result.imported.instances.size(), 1U);
  EXPECT_EQ(result.imported.instances[0].node, 0U);
  EXPECT_TRUE(result.scene().lights.empty());
}

// Refusals.

TEST(ImportScene, WhatCannotBeBakedIsSaid) {
  EXPECT_EQ(verdict(GltfBuilder()), "nothing to bake: the scene has no triangles");
}

/// A square of which every extension has something to say.
GltfBuilder square_with_every_extension() {
  GltfBuilder builder;
  const std::size_t texture = builder.add_texture(1, 1, {255, 200, 100, 128});
  builder.json["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 0;
  Json info = {{"index", texture}};
  info["extensions"]["KHR_texture_transform"] = {
      {"offset", {1, 2}}, {"scale", {3, 4}}, {"rotation", 1}, {"texCoord", 0}};
  const Json volume = {{"thicknessFactor", 1.0}, {"attenuationDistance", 1.0}, {"attenuationColor", {1.0, 0.5, 0.2}}};
  Json material = {{"emissiveFactor", {1.0, 1.0, 1.0}}, {"emissiveTexture", info}};
  material["extensions"] = {
      {"KHR_materials_emissive_strength", {{"emissiveStrength", 2.0}}},
      {"KHR_materials_pbrSpecularGlossiness",
       {{"diffuseFactor", {1, 1, 1, 1}}, {"specularFactor", {1, 1, 1}}, {"diffuseTexture", info}}},
      {"KHR_materials_transmission", {{"transmissionFactor", 0.5}, {"transmissionTexture", info}}},
      {"KHR_materials_volume", volume},
      {"KHR_materials_diffuse_transmission",
       {{"diffuseTransmissionFactor", 0.5},
        {"diffuseTransmissionColorFactor", {1, 1, 1}},
        {"diffuseTransmissionTexture", info}}}};
  PrimitiveParts parts = unit_square();
  parts.material = builder.add_material(material);
  Json node;
  node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
      builder.add_accessor(std::vector<glm::vec3>{{1, 0, 0}, {2, 0, 0}});
  node["extensions"]["KHR_node_visibility"]["visible"] = true;
  builder.add_node(builder.add_mesh(parts), node);
  builder.json["animations"] = Json::parse(R"([{"channels": [{"target": {"node": 0, "path": "weights"}}]}])");
  builder.add_light({{"type", "point"}});
  return builder;
}

TEST(ImportScene, ReplacingAnyValueOfAnExtensionNeverCrashes) {
  const GltfBuilder sound = square_with_every_extension();
  EXPECT_EQ(verdict(sound), "fine");
  std::size_t fine = 0, refused = 0;
  const Json flat = sound.json.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    for (const Json& other :
         {Json(nullptr), Json(-1), Json(1e300), Json("x"), Json::array(), Json::object(), Json(3)}) {
      for (auto at = Json::json_pointer(pointer); !at.empty(); at.pop_back()) {
        GltfBuilder changed = sound;
        changed.json[at] = other;
        EXPECT_NO_THROW(++(verdict(changed) == "fine" ? fine : refused)) << at << " " << other;
      }
    }
  }
  EXPECT_GT(fine, 0U);
  EXPECT_GT(refused, 0U);
}

}  // namespace
}  // namespace gltf_radiosity
