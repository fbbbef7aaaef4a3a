#include "plugin/export_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

const radiosity::Rgb kWhiteLight(std::numbers::pi_v<float>);  // white shows 1 cd/m2

struct Exported {
  Document before, after;  ///< `after` as a reader of the file sees it
  ExportReport report;
  std::vector<Warning> warnings;

  const Json& primitive(std::size_t mesh, std::size_t primitive = 0) const {
    return after.json["meshes"][mesh]["primitives"][primitive];
  }
  const Json& material_of(std::size_t mesh, std::size_t primitive_index = 0) const {
    return after.json["materials"][primitive(mesh, primitive_index)["material"].get<std::size_t>()];
  }
  std::vector<float> colors(std::size_t mesh) const {
    return as_floats(read_accessor(after, primitive(mesh)["attributes"]["COLOR_0"].get<std::size_t>()));
  }
};

Exported exported(const GltfBuilder& builder, int levels = 0, const Options& options = {}) {
  HandBake hand = bake_by_hand(builder, levels, kWhiteLight, options);
  Exported result;
  result.before = hand.document;
  result.report = export_scene(hand.document, hand.added, hand.scene, hand.bake, options, result.warnings, {});
  result.after = read_back(hand.document, hand.added);
  return result;
}

std::vector<std::string> codes_of(const std::vector<Warning>& warnings) {
  std::vector<std::string> codes;
  for (const Warning& warning : warnings) codes.push_back(warning.code);
  return codes;
}

bool is_unlit(const Json& material) {
  return material.contains("extensions") && material["extensions"].contains("KHR_materials_unlit");
}

/// `tree` without what an export adds or changes, for comparing the rest.
Json without_ours(Json tree, const Json& original) {
  for (const char* array : {"accessors", "bufferViews"}) {
    Json& elements = tree[array];
    elements.erase(elements.begin() + static_cast<std::ptrdiff_t>(original[array].size()), elements.end());
  }
  for (const char* key : {"buffers", "materials", "extensionsUsed"}) tree.erase(key);
  if (tree["asset"].contains("extras")) tree["asset"]["extras"].erase("radiosity");
  for (Json& mesh : tree["meshes"]) {
    for (Json& primitive : mesh["primitives"]) {
      for (const char* key : {"attributes", "indices", "targets", "material", "mode"}) primitive.erase(key);
      if (primitive.contains("extras")) primitive["extras"].erase("radiosity");
    }
  }
  return tree;
}

TEST(ExportScene, WhatIsNotOursSurvives) {
  GltfBuilder builder;
  PrimitiveParts parts = unit_square();
  parts.material = builder.add_material({{"name", "wall"}, {"extras", {1, 2}}});
  Json primitive = builder.primitive(parts);
  primitive["extras"] = {{"tag", "p"}};
  primitive["extensions"] = {{"VENDOR_mesh", {{"lod", 3}}}};
  const std::size_t mesh = builder.add_mesh(Json::array({primitive}));
  builder.json["meshes"][mesh]["extras"] = "mesh";
  builder.json["meshes"][mesh]["extensions"]["VENDOR_thing"] = {{"mesh", "not a number"}};
  builder.json["accessors"][0]["extras"] = "accessor";
  builder.json["bufferViews"][0]["name"] = "view";
  builder.add_node(mesh, {{"name", "N\u00f6de"},
                          {"extras", {{"deep", {{"er", {nullptr, true, 1e-300, 12345678901234}}}}}},
                          {"extensions", {{"VENDOR_node", Json::object()}}}});
  builder.add_node(std::nullopt, {{"camera", 0}});
  builder.json["cameras"] = Json::parse(R"([{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.01}}])");
  builder.json["scenes"].push_back({{"name", "other"}, {"extras", {{"kept", true}}}});
  builder.json["samplers"] = Json::parse(R"([{"wrapS": 33071}])");
  builder.json["images"] = Json::parse(R"([{"uri": "data:image/png;base64,iVBORw==", "name": "unused"}])");
  builder.json["textures"] = Json::parse(R"([{"source": 0, "sampler": 0}])");
  builder.json["animations"] = Json::parse(R"([{"name": "none", "channels": [], "samplers": []}])");
  builder.json["extensions"]["VENDOR_root"] = {{"list", {1, 2, 3}}};
  builder.json["extensionsUsed"] = {"VENDOR_root", "VENDOR_node", "VENDOR_mesh", "VENDOR_thing"};
  builder.json["extras"] = "root";
  builder.json["VENDOR_unknown_member"] = 5;
  builder.json["asset"]["extras"]["author"] = "somebody";

  for (const int levels : {0, 2}) {
    const Exported result = exported(builder, levels);
    EXPECT_EQ(without_ours(result.after.json, result.before.json),
              without_ours(result.before.json, result.before.json));
    EXPECT_EQ(result.material_of(0)["name"], "wall");
    EXPECT_EQ(result.material_of(0)["extras"], Json({1, 2}));
    EXPECT_THAT(result.after.json["extensionsUsed"].get<std::vector<std::string>>(),
                testing::UnorderedElementsAre("VENDOR_root", "VENDOR_node", "VENDOR_mesh", "VENDOR_thing",
                                              "KHR_materials_unlit"));
    for (std::size_t i = 0; i < result.before.json["accessors"].size(); ++i) {
      EXPECT_EQ(read_accessor(result.after, i).bytes, read_accessor(result.before, i).bytes) << i;
    }
  }
}

TEST(ExportScene, KnowsWhatATextureMakesWrongOfAnEmission) {
  // All is lit alike, but half of the base colour is black, and with it what is emitted.
  GltfBuilder builder;
  PrimitiveParts parts = unit_square();
  const std::size_t texture = builder.add_texture(2, 1, {255, 255, 255, 255, 0, 0, 0, 255});
  Json material = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}};
  parts.material = builder.add_material(material);
  builder.add_node(builder.add_mesh(parts));
  Options options;
  options.exposure = 0.001;
  EXPECT_EQ(exported(builder, 0, options).report.texture_error, 0.0) << "nothing is emitted";
  material["emissiveFactor"] = {1.0, 1.0, 1.0};
  parts.material = builder.add_material(material);
  builder.add_node(builder.add_mesh(parts));
  EXPECT_GT(exported(builder, 0, options).report.texture_error, 0.3);
}

TEST(ExportScene, AnUncutPrimitiveKeepsItsAccessors) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(unit_square()));
  const Exported result = exported(builder);
  Json primitive = result.primitive(0);
  EXPECT_EQ(result.colors(0), std::vector<float>(16, 1.0F));
  primitive["attributes"].erase("COLOR_0");
  for (const char* ours : {"material", "extras"}) primitive.erase(ours);
  EXPECT_EQ(primitive, result.before.json["meshes"][0]["primitives"][0]);
}

TEST(ExportScene, APrimitiveWithoutMaterialGetsAnUnlitOne) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(unit_square()));
  EXPECT_TRUE(is_unlit(exported(builder).material_of(0)));
}

TEST(ExportScene, OldColoursAreReplacedAndOthersKept) {
  GltfBuilder builder;
  PrimitiveParts parts = unit_square();
  parts.colors.assign(4, glm::vec4(0.5F, 0.5F, 0.5F, 1.0F));
  Json primitive = builder.primitive(parts);
  primitive["attributes"]["COLOR_1"] = builder.add_accessor(std::vector<glm::vec4>(4, glm::vec4(0.25F)));
  builder.add_node(builder.add_mesh(Json::array({primitive})));
  const Exported result = exported(builder, 1);
  EXPECT_FLOAT_EQ(result.colors(0)[0], 0.5F);
  const auto old = result.primitive(0)["attributes"]["COLOR_1"].get<std::size_t>();
  EXPECT_EQ(as_floats(read_accessor(result.after, old)), std::vector<float>(36, 0.25F));
}

TEST(ExportScene, NodesThatShareAMeshGetTheirOwnColours) {
  GltfBuilder builder;
  const std::size_t mesh = builder.add_mesh(unit_square());
  builder.json["meshes"][mesh]["name"] = "tile";
  builder.add_node(mesh);
  builder.add_node(mesh, {{"translation", {3.0, 0.0, 0.0}}});
  const Exported result = exported(builder);
  ASSERT_EQ(result.after.json["meshes"].size(), 2U);
  EXPECT_EQ(result.after.json["nodes"][0]["mesh"], 0);
  EXPECT_EQ(result.after.json["nodes"][1]["mesh"], 1);
  EXPECT_EQ(result.after.json["meshes"][1]["name"], "tile");
  const Json &first = result.primitive(0), &second = result.primitive(1);
  EXPECT_NE(first["attributes"]["COLOR_0"], second["attributes"]["COLOR_0"]);
  EXPECT_EQ(first["attributes"]["POSITION"], second["attributes"]["POSITION"]);
  EXPECT_EQ(first["indices"], second["indices"]);
  EXPECT_EQ(first["material"], second["material"]);
}

TEST(ExportScene, AMeshOfAnotherSceneStaysAsItIs) {
  GltfBuilder builder;
  PrimitiveParts parts = unit_square();
  parts.material = builder.add_material({{"name", "shared"}});
  const std::size_t mesh = builder.add_mesh(parts);
  builder.add_node(mesh);
  builder.json["nodes"].push_back({{"mesh", mesh}});
  builder.json["scenes"].push_back({{"nodes", Json::array({1})}});
  const Exported result = exported(builder, 1);
  EXPECT_EQ(result.after.json["meshes"][0], result.before.json["meshes"][0]);
  EXPECT_EQ(result.after.json["materials"][0], result.before.json["materials"][0]);
  EXPECT_EQ(result.after.json["nodes"][0]["mesh"], 1);
  EXPECT_EQ(result.after.json["nodes"][1]["mesh"], 0);
  EXPECT_TRUE(is_unlit(result.material_of(1)));
}

TEST(ExportScene, AMeshThatExtrasNameByNoIndexIsNoReference) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(unit_square()));
  builder.json["extras"] = {{"of", {{{"mesh", -2.0}}, {{"mesh", 0.5}}, {{"mesh", 1e300}}}}};
  const Exported result = exported(builder);
  EXPECT_EQ(result.after.json["meshes"].size(), 1U);
  EXPECT_EQ(result.after.json["extras"]["of"], result.before.json["extras"]["of"]);
}

TEST(ExportScene, MaterialsOnlyBakedPrimitivesUseAreReplaced) {
  GltfBuilder builder;
  PrimitiveParts parts = unit_square();
  parts.material = builder.add_material({{"name", "wall"}});
  builder.add_node(builder.add_mesh(parts));
  builder.add_node(builder.add_mesh(parts));
  const Exported result = exported(builder);
  EXPECT_EQ(result.after.json["materials"].size(), 1U);
  EXPECT_EQ(result.primitive(0)["material"], 0);
  EXPECT_EQ(result.primitive(1)["material"], 0);
}

TEST(ExportScene, AMaterialOfLinesIsCloned) {
  GltfBuilder builder;
  PrimitiveParts parts = unit_square();
  parts.material = builder.add_material({{"name", "ink"}});
  PrimitiveParts lines = parts;
  lines.mode = 1;
  lines.indices = {0, 1, 2, 3};
  builder.add_node(builder.add_mesh(Json::array({builder.primitive(parts), builder.primitive(lines)})));
  const Exported result = exported(builder);
  EXPECT_EQ(result.primitive(0, 1), result.before.json["meshes"][0]["primitives"][1]);
  EXPECT_FALSE(is_unlit(result.material_of(0, 1)));
  EXPECT_TRUE(is_unlit(result.material_of(0, 0)));
}

TEST(ExportScene, AnUnlitPrimitiveStaysUntouched) {
  GltfBuilder builder;
  PrimitiveParts parts = unit_square();
  builder.add_node(builder.add_mesh(parts));
  parts.material = builder.add_material({{"extensions", {{"KHR_materials_unlit", Json::object()}}}});
  builder.json["extensionsUsed"] = Json::array({"KHR_materials_unlit"});
  builder.add_node(builder.add_mesh(parts));
  const Exported result = exported(builder, 1);
  EXPECT_EQ(result.after.json["meshes"][1], result.before.json["meshes"][1]);
}

TEST(ExportScene, VariantsAreDroppedWithAWarning) {
  GltfBuilder builder;
  PrimitiveParts parts = unit_square();
  parts.material = builder.add_material({{"name", "a"}});
  Json primitive = builder.primitive(parts);
  primitive["extensions"]["KHR_materials_variants"]["mappings"] =
      Json::array({Json{{"material", builder.add_material({{"name", "b"}})}, {"variants", Json::array({0})}}});
  builder.json["extensions"]["KHR_materials_variants"]["variants"] = Json::parse(R"([{"name": "red"}])");
  builder.json["extensionsUsed"] = Json::array({"KHR_materials_variants"});
  builder.add_node(builder.add_mesh(Json::array({primitive})));
  const Exported result = exported(builder);
  EXPECT_FALSE(result.primitive(0).contains("extensions"));
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_EQ(result.warnings[0].code, "variants-dropped");
  EXPECT_EQ(result.warnings[0].place, "meshes[0].primitives[0]");
  EXPECT_EQ(result.after.json["extensions"], result.before.json["extensions"]);
}

TEST(ExportScene, TheFileSaysHowItWasExposed) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(unit_square()));
  builder.json["asset"]["extras"]["author"] = "somebody";
  Options options;
  options.exposure = 0.5;
  const Exported result = exported(builder, 0, options);
  EXPECT_EQ(result.colors(0)[0], 0.5F);
  const Json& asset = result.after.json["asset"];
  EXPECT_EQ(asset["extras"]["author"], "somebody");
  EXPECT_EQ(asset["extras"]["radiosity"]["exposure"], 0.5);
  EXPECT_EQ(asset["extras"]["radiosity"]["clipped"], 0.0);
  EXPECT_EQ(asset["extras"]["radiosity"]["version"], std::string(version()));
  EXPECT_EQ(asset["generator"], "gltf_builder");
}

TEST(ExportScene, ExtrasThatAreNoObjectAreKeptBesideOurs) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(unit_square()));
  builder.json["asset"]["extras"] = "a note";
  const Exported result = exported(builder);
  EXPECT_EQ(result.after.json["asset"]["extras"]["original"], "a note");
  EXPECT_TRUE(result.after.json["asset"]["extras"].contains("radiosity"));
}

TEST(ExportScene, ClippedAreaIsCounted) {
  GltfBuilder builder;
  builder.add_node(builder.add_mesh(unit_square()));
  Options options;
  options.exposure = 2.0;
  EXPECT_DOUBLE_EQ(exported(builder, 0, options).report.clipped_share, 1.0);
}

TEST(ExportScene, DarkScenesAreBrightened) {
  GltfBuilder builder;
  PrimitiveParts parts = unit_square();
  parts.material = builder.add_material({{"pbrMetallicRoughness", {{"baseColorFactor", {0.01, 0.01, 0.01, 1.0}}}}});
  builder.add_node(builder.add_mesh(parts));
  const Exported result = exported(builder);
  EXPECT_NEAR(result.report.exposure, 90.0, 0.01);
  EXPECT_NEAR(result.colors(0)[0], 0.9F, 1e-5F);
}

TEST(ExportScene, CountsAreThoseOfTheFile) {
  GltfBuilder builder;
  const std::size_t mesh = builder.add_mesh(unit_square());
  builder.add_node(mesh);
  builder.add_node(mesh, {{"translation", {3.0, 0.0, 0.0}}});
  const ExportReport report = exported(builder, 1).report;
  EXPECT_EQ(report.triangles, 16U);
  EXPECT_EQ(report.vertices, 18U);
}

/// Two squares of one dark red material, lit alike.
GltfBuilder two_dark_squares() {
  GltfBuilder builder;
  PrimitiveParts parts = unit_square();
  parts.material = builder.add_material({{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 0.125, 1.0}}}}});
  builder.add_node(builder.add_mesh(parts));
  builder.add_node(builder.add_mesh(parts));
  return builder;
}

TEST(ExportScene, ColoursScaledUpComeDownWithTheFactor) {
  Options options;
  options.exposure = 1.0;
  options.scale_to_factor = true;
  const Exported scene = exported(two_dark_squares(), 0, options);
  EXPECT_EQ(scene.colors(0), std::vector<float>(16, 1.0F));
  const Json& factor = scene.material_of(0)["pbrMetallicRoughness"]["baseColorFactor"];
  EXPECT_NEAR(factor[0].get<float>(), 0.5F, 1e-6F);
  EXPECT_NEAR(factor[2].get<float>(), 0.125F, 1e-6F);
  EXPECT_EQ(scene.primitive(0)["material"], scene.primitive(1)["material"]) << "alike, so they still share it";
  EXPECT_EQ(scene.after.json["materials"].size(), 1U);
}

TEST(ExportScene, MaterialsThatAreKeptStayAsTheyWere) {
  Options options;
  options.target = Target::kKeep;
  options.exposure = 1.0;
  GltfBuilder builder = two_dark_squares();
  builder.json["materials"][0]["emissiveFactor"] = {1.0, 1.0, 1.0};
  const Exported scene = exported(builder, 0, options);
  EXPECT_EQ(scene.after.json["materials"], scene.before.json["materials"]);
  EXPECT_EQ(scene.primitive(0)["material"], 0);
  EXPECT_FALSE(scene.after.json.contains("extensionsUsed"));
  EXPECT_EQ(scene.after.json["asset"]["extras"]["radiosity"]["target"], "keep");
  for (const float value : scene.colors(0)) EXPECT_NEAR(value, 1.0F, 1e-6F) << "light without colour and emission";
}

TEST(ExportScene, WhatIsBakedIsNotSeenThroughAnyMore) {
  GltfBuilder builder = two_dark_squares();
  builder.json["materials"][0]["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 0.5}};
  EXPECT_THAT(codes_of(exported(builder).warnings), testing::ElementsAre("transmission-opaque"));
  Options keep;
  keep.target = Target::kKeep;
  EXPECT_THAT(codes_of(exported(builder, 0, keep).warnings), testing::IsEmpty()) << "unless its material stays";
}

TEST(ExportScene, KeptMaterialsCanBeScaledToo) {
  Options options;
  options.target = Target::kKeep;
  options.exposure = 0.5;
  options.scale_to_factor = true;
  const Exported scene = exported(two_dark_squares(), 0, options);
  EXPECT_FALSE(is_unlit(scene.material_of(0)));
  EXPECT_NEAR(scene.material_of(0)["pbrMetallicRoughness"]["baseColorFactor"][0].get<float>(), 0.25F, 1e-6F);
  EXPECT_EQ(scene.colors(0), std::vector<float>(16, 1.0F));
}

TEST(ExportScene, IndirectLightHoldsNoEmission) {
  Options options;
  options.bake = BakedLight::kIndirect;
  options.exposure = 0.25;
  GltfBuilder builder = two_dark_squares();
  builder.json["materials"][0]["emissiveFactor"] = {1.0, 1.0, 1.0};
  const Exported scene = exported(builder, 0, options);
  EXPECT_NEAR(scene.colors(0)[0], 0.125F, 1e-6F);
  EXPECT_EQ(scene.after.json["asset"]["extras"]["radiosity"]["light"], "indirect");
}

TEST(ExportScene, TheRadianceStandsBesideTheColours) {
  Options options;
  options.exposure = 8.0;
  options.radiance_attribute = "LIGHT";
  const Exported scene = exported(two_dark_squares(), 0, options);
  const auto accessor = scene.primitive(0)["attributes"]["_LIGHT"].get<std::size_t>();
  const std::vector<float> light = as_floats(read_accessor(scene.after, accessor));
  EXPECT_NEAR(light[0], 4.0F, 1e-5F);
  EXPECT_NEAR(light[2], 1.0F, 1e-5F);
  EXPECT_EQ(scene.colors(0)[0], 1.0F);
}

TEST(ExportScene, CopiesOfAMaterialHaveNamesOfTheirOwn) {
  Options options;
  options.exposure = 1.0;
  options.scale_to_factor = true;
  GltfBuilder builder = two_dark_squares();
  builder.json["materials"][0]["name"] = "red";
  const std::size_t old_colors = builder.add_accessor(std::vector<glm::vec4>(4, {0.5F, 0.5F, 0.5F, 1.0F}));
  builder.json["meshes"][1]["primitives"][0]["attributes"]["COLOR_0"] = old_colors;
  const Exported scene = exported(builder, 0, options);
  EXPECT_EQ(scene.material_of(0)["name"], "red");
  EXPECT_EQ(scene.material_of(1)["name"], "red.2");
}

}  // namespace
}  // namespace gltf_radiosity
