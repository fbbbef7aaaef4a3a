#include "plugin/export_materials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gltf_radiosity {
namespace {

const Json kEverything = Json::parse(R"({
  "name": "wall",
  "extras": {"id": 7},
  "pbrMetallicRoughness": {
    "baseColorFactor": [0.5, 0.25, 0.125, 0.75],
    "baseColorTexture": {"index": 2, "texCoord": 1, "extensions": {"KHR_texture_transform": {"scale": [2, 2]}}},
    "metallicFactor": 0.5,
    "roughnessFactor": 0.25,
    "metallicRoughnessTexture": {"index": 3},
    "extras": "kept"
  },
  "normalTexture": {"index": 4},
  "occlusionTexture": {"index": 5},
  "emissiveTexture": {"index": 6},
  "emissiveFactor": [1, 1, 1],
  "alphaMode": "MASK",
  "alphaCutoff": 0.25,
  "doubleSided": true,
  "extensions": {
    "KHR_materials_emissive_strength": {"emissiveStrength": 5},
    "KHR_materials_clearcoat": {},
    "MSFT_packing_normalRoughnessMetallic": {},
    "VENDOR_physics": {"density": 2}
  }
})");

ImportedMaterial imported(std::optional<std::uint32_t> source, float alpha = 1.0F) {
  ImportedMaterial material;
  material.source = source;
  material.base_color_factor = {0.5F, 0.25F, 0.125F, alpha};
  return material;
}

TEST(ExportMaterials, AnUnlitMaterialMayShowWhatItEmitted) {
  Json source = kEverything;
  source["emissiveTexture"]["extensions"]["KHR_texture_transform"] = {{"scale", {3, 3}}};
  const Json unlit = unlit_material(source, imported(0), radiosity::Rgb(1.0F), ShownTexture::kEmissive);
  EXPECT_EQ(unlit["pbrMetallicRoughness"]["baseColorTexture"], source["emissiveTexture"]);
  EXPECT_FALSE(unlit.contains("emissiveTexture"));
}

TEST(ExportMaterials, AnUnlitMaterialShowsNothingButBaseColour) {
  const Json expected = Json::parse(R"({
    "name": "wall",
    "extras": {"id": 7},
    "pbrMetallicRoughness": {
      "baseColorTexture": {"index": 2, "texCoord": 1, "extensions": {"KHR_texture_transform": {"scale": [2, 2]}}},
      "baseColorFactor": [1.0, 1.0, 1.0, 0.75],
      "metallicFactor": 0.0,
      "roughnessFactor": 1.0,
      "extras": "kept"
    },
    "alphaMode": "MASK",
    "alphaCutoff": 0.25,
    "doubleSided": true,
    "extensions": {"VENDOR_physics": {"density": 2}, "KHR_materials_unlit": {}}
  })");
  EXPECT_EQ(nlohmann::json(unlit_material(kEverything, imported(0, 0.75F))), nlohmann::json(expected));
}

TEST(ExportMaterials, TheDiffuseTextureOfSpecularGlossinessBecomesTheBaseColorTexture) {
  Json source = Json::parse(R"({
    "pbrMetallicRoughness": {"baseColorTexture": {"index": 1}},
    "extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseTexture": {"index": 2, "texCoord": 1}}}
  })");
  const Json unlit = unlit_material(source, imported(0));
  EXPECT_EQ(unlit["pbrMetallicRoughness"]["baseColorTexture"], Json::parse(R"({"index": 2, "texCoord": 1})"));
  EXPECT_EQ(unlit["extensions"], Json::parse(R"({"KHR_materials_unlit": {}})"));
  source["extensions"]["KHR_materials_pbrSpecularGlossiness"].erase("diffuseTexture");
  EXPECT_FALSE(unlit_material(source, imported(0))["pbrMetallicRoughness"].contains("baseColorTexture"));
}

TEST(ExportMaterials, AFactorOfOneIsLeftOut) {
  EXPECT_FALSE(unlit_material(kEverything, imported(0))["pbrMetallicRoughness"].contains("baseColorFactor"));
}

TEST(ExportMaterials, TheDefaultMaterialBecomesUnlitToo) {
  Document document;
  document.json = Json::object();
  std::set<std::size_t> referenced;
  const Json unlit = unlit_material(Json::object(), imported(std::nullopt));
  EXPECT_EQ(export_material(document, imported(std::nullopt), unlit, referenced), 0U);
  EXPECT_EQ(document.json["materials"][0]["extensions"], Json::parse(R"({"KHR_materials_unlit": {}})"));
  EXPECT_EQ(document.json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"], 0.0);
}

TEST(ExportMaterials, AMaterialNobodyElseUsesIsReplaced) {
  Document document;
  document.json["materials"] = Json::parse(R"([{"name": "a"}, {"name": "b"}])");
  std::set<std::size_t> referenced = {0};
  EXPECT_EQ(export_material(document, imported(1), {{"name", "b, baked"}}, referenced), 1U);
  EXPECT_EQ(document.json["materials"].size(), 2U);
  EXPECT_EQ(document.json["materials"][1]["name"], "b, baked");
  // The place is taken: a second version is appended.
  EXPECT_EQ(export_material(document, imported(1), {{"name", "b, dimmed"}}, referenced), 2U);
  EXPECT_EQ(document.json["materials"][1]["name"], "b, baked");
}

TEST(ExportMaterials, AMaterialSomebodyElseUsesIsCloned) {
  Document document;
  document.json["materials"] = Json::parse(R"([{"name": "a"}])");
  std::set<std::size_t> referenced = {0};
  EXPECT_EQ(export_material(document, imported(0), {{"name", "a, baked"}}, referenced), 1U);
  EXPECT_EQ(document.json["materials"][0], Json({{"name", "a"}}));
  EXPECT_EQ(document.json["materials"][1]["name"], "a, baked");
}

TEST(ExportMaterials, AFactorThatColoursWereDividedByComesBack) {
  const Json unlit = unlit_material(kEverything, imported(0, 0.75F), {0.5F, 0.25F, 1.0F});
  EXPECT_EQ(unlit["pbrMetallicRoughness"]["baseColorFactor"], Json({0.5, 0.25, 1.0, 0.75}));
}

TEST(ExportMaterials, AMaterialThatStaysLitIsOnlyDimmed) {
  Json expected = kEverything;
  expected["pbrMetallicRoughness"]["baseColorFactor"] = {0.25, 0.25, 0.03125, 0.75};
  EXPECT_EQ(dimmed_material(kEverything, {0.5F, 1.0F, 0.25F}), expected);
}

TEST(ExportMaterials, BothColoursOfSpecularGlossinessAreDimmed) {
  const Json source = Json::parse(R"({
    "extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.5, 0.5, 1, 0.5], "glossinessFactor": 0}}
  })");
  const Json dimmed = dimmed_material(source, {0.5F, 1.0F, 0.25F});
  EXPECT_EQ(dimmed["pbrMetallicRoughness"]["baseColorFactor"], Json({0.5, 1.0, 0.25, 1.0}));
  const Json& glossy = dimmed["extensions"]["KHR_materials_pbrSpecularGlossiness"];
  EXPECT_EQ(glossy["diffuseFactor"], Json({0.25, 0.5, 0.25, 0.5}));
  EXPECT_EQ(glossy["glossinessFactor"], 0);
}

TEST(ExportMaterials, EveryKindOfReferenceIsFound) {
  const Json root = Json::parse(R"({
    "meshes": [{"primitives": [{"material": 1},
                               {"extensions": {"KHR_materials_variants": {"mappings": [{"material": 2}]}}}]}],
    "animations": [{"channels": [{"target": {"extensions": {"KHR_animation_pointer": {
        "pointer": "/materials/30/emissiveFactor"}}}}]}],
    "materials": [{"extensions": {"MSFT_lod": {"ids": [4]}}}],
    "extensions": {"VENDOR_palette": {"materials": [5]}},
    "nodes": [{"mesh": 6}]
  })");
  EXPECT_THAT(referenced_materials(root), testing::ElementsAre(1, 2, 4, 5, 30));
}

TEST(ExportMaterials, AReferenceIsAnIndexWhateverExtensionsCallAMaterial) {
  const Json root = Json::parse(R"({"extensions": {"EXAMPLE_shop": {"material": -1e38, "materials": [1.5, "oak"]},
                                                   "MSFT_lod": {"ids": [-1, 3, 1e300]}}})");
  EXPECT_THAT(referenced_materials(root), testing::ElementsAre(3));
}

TEST(ExportMaterials, ExtensionsThatNoMaterialHasAnyMoreAreForgotten) {
  Json root = Json::parse(R"({
    "extensionsUsed": ["KHR_materials_clearcoat", "KHR_materials_sheen", "KHR_materials_unlit", "KHR_lights_punctual",
                       "KHR_materials_variants"],
    "extensionsRequired": ["KHR_materials_clearcoat"],
    "materials": [{"extensions": {"KHR_materials_sheen": {}, "KHR_materials_unlit": {}}}]
  })");
  forget_unused_material_extensions(root);
  EXPECT_EQ(root["extensionsUsed"],
            Json({"KHR_materials_sheen", "KHR_materials_unlit", "KHR_lights_punctual", "KHR_materials_variants"}));
  EXPECT_FALSE(root.contains("extensionsRequired"));
}

}  // namespace
}  // namespace gltf_radiosity
