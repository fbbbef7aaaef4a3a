#include "plugin/import_materials.h"

#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include "tests/plugin/gltf_builder.h"

namespace gltf_radiosity {
namespace {

struct ReadMaterial {
  ImportedMaterial material;
  std::vector<Warning> warnings;
};

/// The last material of what `builder` made.
ReadMaterial import_last(const GltfBuilder& builder, Metals metals = Metals::kDiffuse) {
  const Document document = builder.document();
  const auto model = typed_view(document);
  EXPECT_TRUE(model) << model.error().text();
  ReadMaterial result;
  TextureLibrary textures(document, result.warnings);
  const auto last = static_cast<std::uint32_t>(document.json["materials"].size() - 1);
  const auto material = import_material(document, **model, last, metals, textures);
  EXPECT_TRUE(material) << material.error().text();
  if (material) result.material = *material;
  return result;
}

ReadMaterial import_from(const Json& json) {
  GltfBuilder builder;
  builder.add_material(json);
  return import_last(builder);
}

TEST(Materials, DefaultsAreThoseOfGltf) {
  const ImportedMaterial material = import_from({{"name", "plain"}}).material;
  EXPECT_EQ(material.base_color_factor, glm::vec4(1.0F));
  EXPECT_FALSE(material.base_color);
  EXPECT_FALSE(material.emits());
  EXPECT_EQ(material.metallic, 1.0F);
  EXPECT_EQ(material.alpha_mode, AlphaMode::kOpaque);
  EXPECT_EQ(material.alpha_cutoff, 0.5F);
  EXPECT_FALSE(material.double_sided);
  EXPECT_FALSE(material.unlit);
  EXPECT_EQ(material.source, 0U);
}

TEST(Materials, EverythingIsRead) {
  const ImportedMaterial material =
      import_from({{"pbrMetallicRoughness", {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.5}}},
                   {"emissiveFactor", {1.0, 0.5, 0.0}},
                   {"alphaMode", "MASK"},
                   {"alphaCutoff", 0.25},
                   {"doubleSided", true},
                   {"extensions",
                    {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8.0}}},
                     {"KHR_materials_unlit", Json::object()}}}})
          .material;
  EXPECT_EQ(material.base_color_factor, glm::vec4(0.1F, 0.2F, 0.3F, 0.4F));
  EXPECT_EQ(material.metallic, 0.5F);
  EXPECT_EQ(material.emissive, glm::vec3(8.0F, 4.0F, 0.0F));
  EXPECT_EQ(material.alpha_mode, AlphaMode::kMask);
  EXPECT_EQ(material.alpha_cutoff, 0.25F);
  EXPECT_TRUE(material.double_sided);
  EXPECT_TRUE(material.unlit);
}

TEST(Materials, ReflectanceBeyondOneIsCut) {
  const ImportedMaterial material =
      import_from({{"pbrMetallicRoughness", {{"baseColorFactor", {3, -1, 0.5, 1}}}}}).material;
  EXPECT_EQ(material.base_color_factor, glm::vec4(1.0F, 0.0F, 0.5F, 1.0F));
}

TEST(Materials, WholeNumbersAreNumbersToo) {
  const ImportedMaterial material = import_from({{"emissiveFactor", {1, 1, 1}}, {"alphaCutoff", 1}}).material;
  EXPECT_EQ(material.emissive, glm::vec3(1.0F));
  EXPECT_EQ(material.alpha_cutoff, 1.0F);
}

TEST(Materials, TexturesKeepTheirOwnKind) {
  GltfBuilder builder;
  const std::size_t texture = builder.add_texture(1, 1, {188, 188, 188, 128});
  Json json = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}, {"texCoord", 1}}}}},
               {"emissiveTexture", {{"index", texture}}},
               {"emissiveFactor", {1, 1, 1}}};
  builder.add_material(json);
  const ImportedMaterial material = import_last(builder).material;
  EXPECT_EQ(material.base_color.texcoord, 1);
  EXPECT_NEAR(material.base_color.at({0, 0}).x, 0.5029F, 1e-3F);
  EXPECT_NEAR(material.emissive_texture.at({0, 0}).x, 0.5029F, 1e-3F);
}

TEST(Materials, TexturesWithoutInfluenceAreNotRead) {
  // Both textures are broken images: reading them would be an error.
  GltfBuilder builder;
  const std::size_t view = builder.add_buffer_view(std::vector<std::uint8_t>{1, 2, 3});
  builder.json["images"] = Json::array({Json{{"bufferView", view}}});
  builder.json["textures"] = Json::array({Json{{"source", 0}}});
  builder.add_material(
      {{"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", 0}}}}}, {"emissiveTexture", {{"index", 0}}}});
  EXPECT_FALSE(import_last(builder).material.emissive_texture);
}

TEST(Materials, MetalsAreDiffuseUnlessAskedToBeBlack) {
  GltfBuilder builder;
  const std::size_t texture = builder.add_texture(1, 1, {255, 255, 128, 255});
  builder.add_material(
      {{"pbrMetallicRoughness", {{"metallicFactor", 0.5}, {"metallicRoughnessTexture", {{"index", texture}}}}}});
  const ImportedMaterial diffuse = import_last(builder, Metals::kDiffuse).material;
  EXPECT_EQ(diffuse.diffuse_share(1.0F), 1.0F);
  const ImportedMaterial black = import_last(builder, Metals::kBlack).material;
  EXPECT_NEAR(black.diffuse_share(black.metallic_roughness.at({0, 0}).z), 1.0F - 0.5F * 128.0F / 255.0F, 1e-5F);
}

// Specular-glossiness.

Json glossy(const Json& members) { return {{"extensions", {{"KHR_materials_pbrSpecularGlossiness", members}}}}; }

TEST(Materials, TheDiffuseColorOfSpecularGlossinessIsTheBaseColor) {
  Json json = glossy({{"diffuseFactor", {0.1, 0.2, 0.3, 0.4}}, {"specularFactor", {0.04, 0.04, 0.04}}});
  json["pbrMetallicRoughness"]["baseColorFactor"] = {1, 0, 0, 1};  // for those who do not know the extension
  const ReadMaterial imported = import_from(json);
  const glm::vec4 color = imported.material.base_color_factor;
  EXPECT_NEAR(color.x, 0.1F, 1e-6F);
  EXPECT_NEAR(color.y, 0.2F, 1e-6F);
  EXPECT_NEAR(color.z, 0.3F, 1e-6F);
  EXPECT_EQ(color.w, 0.4F);
  EXPECT_EQ(imported.material.metallic, 0.0F);
  EXPECT_TRUE(imported.warnings.empty());
}

TEST(Materials, AMetalInSpecularGlossinessReflectsItsSpecularColor) {
  const Json gold = glossy({{"diffuseFactor", {0, 0, 0, 1}}, {"specularFactor", {1.0, 0.76, 0.33}}});
  const glm::vec4 color = import_from(gold).material.base_color_factor;
  EXPECT_NEAR(color.x, 1.0F, 1e-5F);
  EXPECT_NEAR(color.y, 0.75F, 1e-5F);
  GltfBuilder builder;
  builder.add_material(gold);
  EXPECT_EQ(import_last(builder, Metals::kBlack).material.base_color_factor, glm::vec4(0, 0, 0, 1));
}

TEST(Materials, TheDiffuseTextureIsTheBaseColorTexture) {
  GltfBuilder builder;
  const std::size_t texture = builder.add_texture(1, 1, {255, 0, 0, 255});
  builder.add_material(glossy({{"diffuseTexture", {{"index", texture}}}, {"diffuseFactor", {0.5, 1, 1, 1}}}));
  const ImportedMaterial material = import_last(builder).material;
  EXPECT_EQ(material.base_color_factor, glm::vec4(0.5F, 1, 1, 1));
  EXPECT_EQ(material.base_color.at({0, 0}), glm::vec4(1, 0, 0, 1));
}

// Transmission.

TEST(Materials, WhatIsTransmittedIsNotReflected) {
  const ImportedMaterial material =
      import_from({{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.75}}}}}}).material;
  EXPECT_TRUE(material.receives());
  const auto white = material.transmission.shares(glm::vec3(1.0F), 1.0F, 1.0F);
  EXPECT_NEAR(white.passes, 0.75F, 1e-6F);
  EXPECT_NEAR(white.reflects, 0.25F, 1e-6F);
  const auto grey = material.transmission.shares(glm::vec3(0.5F), 1.0F, 1.0F);
  EXPECT_NEAR(grey.passes, 0.375F, 1e-6F) << "dyed by the base colour";
  const auto masked = material.transmission.shares(glm::vec3(1.0F), 0.0F, 1.0F);
  EXPECT_EQ(masked.passes, 0.0F);
  EXPECT_EQ(masked.reflects, 1.0F);
}

TEST(Materials, AVolumeTakesItsShareHalfAtEachSurface) {
  const Json volume = {{"thicknessFactor", 2.0}, {"attenuationDistance", 1.0}, {"attenuationColor", {0.5, 0.5, 0.5}}};
  const ImportedMaterial material =
      import_from({{"extensions",
                    {{"KHR_materials_transmission", {{"transmissionFactor", 1.0}}}, {"KHR_materials_volume", volume}}}})
          .material;
  EXPECT_NEAR(material.transmission.shares(glm::vec3(1.0F), 1.0F, 1.0F).passes, 0.5F, 1e-5F);
}

TEST(Materials, DiffuseTransmissionHasAColorOfItsOwn) {
  const Json leaf = {{"diffuseTransmissionFactor", 0.5}, {"diffuseTransmissionColorFactor", {0.2, 0.2, 0.2}}};
  const ImportedMaterial material =
      import_from({{"extensions", {{"KHR_materials_diffuse_transmission", leaf}}}}).material;
  const auto shares = material.transmission.shares(glm::vec3(1.0F), 1.0F, 1.0F);
  EXPECT_NEAR(shares.passes, 0.1F, 1e-6F);
  EXPECT_NEAR(shares.reflects, 0.5F, 1e-6F);
}

TEST(Materials, WhatIsClearEverywhereIsNotBaked) {
  const auto clear = [](const Json& extension) {
    return !import_from({{"extensions", {{"KHR_materials_transmission", extension}}}}).material.receives();
  };
  EXPECT_TRUE(clear({{"transmissionFactor", 1.0}}));
  EXPECT_FALSE(clear({{"transmissionFactor", 0.9}}));
  EXPECT_FALSE(clear({{"transmissionFactor", 0.0}}));
}

}  // namespace
}  // namespace gltf_radiosity
