#include "plugin/import_materials.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <limits>
#include <utility>

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

/// The base colour of a dielectric that reflects as much light as specular-glossiness says, if no texture has a say:
/// what is specular beyond the 4 % of a dielectric counts as if it was painted, as it does with metals.
glm::vec3 base_color_of(const glm::vec3& diffuse, const glm::vec3& specular) {
  constexpr float kDielectric = 0.04F;
  const float strongest = std::max({specular.x, specular.y, specular.z});
  const float usual = std::min(strongest, kDielectric);
  return (diffuse * (1.0F - strongest) + glm::max(specular - usual, 0.0F)) / (1.0F - usual);
}

/// Textures and numbers of one material.
class MaterialImporter {
 public:
  MaterialImporter(const Json& json, TextureLibrary& textures, ImportedMaterial& result)
      : json_(json), textures_(textures), result_(result) {}

  Result<Done> texture(const Json& owner, const char* key, TexelKind kind, TextureSlot& slot) {
    const auto info = owner.find(key);
    if (info == owner.end()) return Done{};
    Result<TextureSlot> read_slot = textures_.slot(*info, kind);
    if (!read_slot) return read_slot.error();
    slot = std::move(*read_slot);
    return Done{};
  }

  /// KHR_materials_pbrSpecularGlossiness replaces the base colour; nothing in it is metallic.
  Result<Done> specular_glossiness(const Json& extension, TexelKind kind) {
    const glm::vec4 diffuse(color_in(extension, "diffuseFactor"), alpha_in(extension, "diffuseFactor"));
    const bool plain = !extension.contains("diffuseTexture") && !extension.contains("specularGlossinessTexture");
    const glm::vec3 base =
        plain && result_.metals_reflect ? base_color_of(diffuse, color_in(extension, "specularFactor")) : diffuse;
    result_.base_color_factor = {base, diffuse.w};
    result_.metallic = 0.0F;
    return texture(extension, "diffuseTexture", kind, result_.base_color);
  }

  Result<Done> transmission() {
    Transmission& through = result_.transmission;
    if (const Json* straight = extension_of(json_, "KHR_materials_transmission")) {
      through.straight = in_unit_range(straight->value("transmissionFactor", 0.0));
      if (through.straight > 0.0F) {
        auto done = texture(*straight, "transmissionTexture", TexelKind::kData, through.straight_texture);
        if (!done) return done;
      }
    }
    if (const Json* volume = extension_of(json_, "KHR_materials_volume")) {
      const double thickness = std::max(volume->value("thicknessFactor", 0.0), 0.0);
      const double distance = volume->value("attenuationDistance", std::numeric_limits<double>::infinity());
      const double surfaces = 2.0;
      if (distance > 0.0) {
        through.attenuation = radiosity::luminance_of(glm::pow(
            color_in(*volume, "attenuationColor"), glm::vec3(static_cast<float>(thickness / distance / surfaces))));
      }
    }
    const Json* diffuse = extension_of(json_, "KHR_materials_diffuse_transmission");
    if (diffuse == nullptr) return Done{};
    through.diffuse = in_unit_range(diffuse->value("diffuseTransmissionFactor", 0.0));
    through.diffuse_tint = radiosity::luminance_of(color_in(*diffuse, "diffuseTransmissionColorFactor"));
    if (through.diffuse == 0.0F) return Done{};
    return texture(*diffuse, "diffuseTransmissionTexture", TexelKind::kData, through.diffuse_texture);
  }

 private:
  /// Three shares; ones where there are none.
  static glm::vec3 color_in(const Json& owner, const char* key) {
    const auto values = owner.find(key);
    if (values == owner.end()) return glm::vec3(1.0F);
    return {in_unit_range((*values)[0].get<double>()), in_unit_range((*values)[1].get<double>()),
            in_unit_range((*values)[2].get<double>())};
  }
  static float alpha_in(const Json& owner, const char* key) {
    const auto values = owner.find(key);
    return values == owner.end() ? 1.0F : in_unit_range((*values)[3].get<double>());
  }

  const Json& json_;
  TextureLibrary& textures_;
  ImportedMaterial& result_;
};

}  // namespace

Transmission::Shares Transmission::shares(const glm::vec3& base_color, float straight_texel,
                                          float diffuse_texel) const {
  const float straight_share = straight * straight_texel;
  const float diffuse_share = (1.0F - straight_share) * diffuse * diffuse_texel;
  return {straight_share * attenuation * radiosity::luminance_of(base_color) + diffuse_share * diffuse_tint,
          1.0F - straight_share - diffuse_share};
}

Result<ImportedMaterial> import_material(const Document& document, const tinygltf::Model& model,
                                         std::optional<std::uint32_t> source, Metals metals, TextureLibrary& textures) {
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

  // Textures, and extensions that bring their own.
  MaterialImporter importer(json, textures, result);
  const Json& pbr_json = json.contains("pbrMetallicRoughness") ? json["pbrMetallicRoughness"] : json;
  const TexelKind kind = result.alpha_mode == AlphaMode::kOpaque ? TexelKind::kColor : TexelKind::kCoveredColor;
  const Json* glossy = extension_of(json, "KHR_materials_pbrSpecularGlossiness");
  if (auto done = glossy != nullptr ? importer.specular_glossiness(*glossy, kind)
                                    : importer.texture(pbr_json, "baseColorTexture", kind, result.base_color);
      !done) {
    return done.error();
  }
  if (result.emits()) {
    auto done = importer.texture(json, "emissiveTexture", TexelKind::kColor, result.emissive_texture);
    if (!done) return done.error();
  }
  if (metals == Metals::kBlack && result.metallic > 0.0F) {
    auto done = importer.texture(pbr_json, "metallicRoughnessTexture", TexelKind::kData, result.metallic_roughness);
    if (!done) return done.error();
  }
  if (auto done = importer.transmission(); !done) return done.error();
  return result;
}

}  // namespace gltf_radiosity
