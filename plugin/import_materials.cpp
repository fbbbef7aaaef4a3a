#include "plugin/import_materials.h"

#include <tiny_gltf.h>

#include <algorithm>

#include "plugin/check_document.h"

namespace gltf_radiosity {
namespace {

float in_unit_range(double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); }

AlphaMode alpha_mode_of(const std::string& name) {
  if (name == "MASK") return AlphaMode::kMask;
  return name == "BLEND" ? AlphaMode::kBlend : AlphaMode::kOpaque;
}

/// The emissive strength and textures need the tree: tinygltf leaves extensions untyped.
glm::vec3 emissive_of(const tinygltf::Material& material, const Json& json) {
  const Json* extension = extension_of(json, "KHR_materials_emissive_strength");
  const double strength = extension == nullptr ? 1.0 : std::max(extension->value("emissiveStrength", 1.0), 0.0);
  glm::vec3 emissive;
  for (int band = 0; band < 3; ++band) {
    const double factor = material.emissiveFactor[static_cast<std::size_t>(band)];
    emissive[band] = static_cast<float>(std::clamp(factor * strength, 0.0, 1e30));
  }
  return emissive;
}

}  // namespace

Result<ImportedMaterial> import_material(const Document& document, const tinygltf::Model& model,
                                         std::optional<std::uint32_t> source, Metals metals, TextureLibrary& textures,
                                         std::vector<Warning>& warnings) {
  ImportedMaterial result;
  result.source = source;
  result.metals_reflect = metals == Metals::kDiffuse;
  if (!source) return result;
  const tinygltf::Material& material = model.materials[*source];
  const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
  const Json& json = document.json["materials"][*source];

  // Numbers.
  for (int band = 0; band < 4; ++band) {
    result.base_color_factor[band] = in_unit_range(pbr.baseColorFactor[static_cast<std::size_t>(band)]);
  }
  result.emissive = emissive_of(material, json);
  result.metallic = in_unit_range(pbr.metallicFactor);
  result.alpha_mode = alpha_mode_of(material.alphaMode);
  result.alpha_cutoff = static_cast<float>(material.alphaCutoff);
  result.double_sided = material.doubleSided;
  result.unlit = extension_of(json, "KHR_materials_unlit") != nullptr;
  if (extension_of(json, "KHR_materials_pbrSpecularGlossiness") != nullptr) {
    warnings.push_back(
        {"specular-glossiness", place_of("materials", *source),
         "KHR_materials_pbrSpecularGlossiness is not supported yet, its metallic-roughness values were used"});
  }

  // Textures.
  const auto read = [&](const Json& owner, const char* key, TexelKind kind, TextureSlot& slot) -> Result<Done> {
    const auto info = owner.find(key);
    if (info == owner.end()) return Done{};
    Result<TextureSlot> read_slot = textures.slot(*info, kind);
    if (!read_slot) return read_slot.error();
    slot = std::move(*read_slot);
    return Done{};
  };
  const Json& pbr_json = json.contains("pbrMetallicRoughness") ? json["pbrMetallicRoughness"] : json;
  const TexelKind kind = result.alpha_mode == AlphaMode::kOpaque ? TexelKind::kColor : TexelKind::kCoveredColor;
  if (auto done = read(pbr_json, "baseColorTexture", kind, result.base_color); !done) return done.error();
  if (result.emits()) {
    auto done = read(json, "emissiveTexture", TexelKind::kColor, result.emissive_texture);
    if (!done) return done.error();
  }
  if (metals == Metals::kBlack && result.metallic > 0.0F) {
    auto done = read(pbr_json, "metallicRoughnessTexture", TexelKind::kData, result.metallic_roughness);
    if (!done) return done.error();
  }
  return result;
}

}  // namespace gltf_radiosity
