// glTF materials -> how surfaces reflect, emit and let light through.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/scene.h"
#include "plugin/document.h"
#include "plugin/import_textures.h"

namespace gltf_radiosity {

enum class AlphaMode { kOpaque, kMask, kBlend };

/// Light that goes through a surface instead of being reflected: KHR_materials_transmission with _volume, straight on
/// and dyed by the base colour, and KHR_materials_diffuse_transmission, which is taken to go straight on too. Rays know
/// no colour, so that what is dyed loses as much in all bands as the dye takes of white.
struct Transmission {
  float straight = 0.0F;         ///< factor of KHR_materials_transmission
  TextureSlot straight_texture;  ///< its red
  float diffuse = 0.0F;          ///< factor of KHR_materials_diffuse_transmission, of the light that is left
  TextureSlot diffuse_texture;   ///< its alpha
  float diffuse_tint = 1.0F;     ///< luminance of its colour
  float attenuation = 1.0F;      ///< what a volume leaves of the light at each of its two surfaces

  explicit operator bool() const { return straight > 0.0F || diffuse > 0.0F; }
  /// Whether nothing is left to be reflected, anywhere.
  bool is_clear() const { return (straight >= 1.0F && !straight_texture) || (diffuse >= 1.0F && !diffuse_texture); }

  /// Shares of the light that falls on the surface, where its base colour is `base_color` and the textures hold these
  /// texels.
  struct Shares {
    float passes = 0.0F;    ///< goes through
    float reflects = 1.0F;  ///< is left for the base colour to reflect
  };
  Shares shares(const glm::vec3& base_color, float straight_texel, float diffuse_texel) const;
};

/// A glTF material as light sees it. Colours are linear Rec. 709.
struct ImportedMaterial {
  std::optional<std::uint32_t> source;  ///< index in the document's materials; none for the default material
  glm::vec4 base_color_factor{1.0F};
  TextureSlot base_color;        ///< sRGB; unused slots answer white
  glm::vec3 emissive{0.0F};      ///< factor times KHR_materials_emissive_strength, cd/m2
  glm::vec3 dimmed{0.0F};        ///< what is added in bands where it is none and a dimmer takes it away
  TextureSlot emissive_texture;  ///< sRGB; empty if `emissive` is black
  Transmission transmission;
  float metallic = 1.0F;
  TextureSlot metallic_roughness;  ///< blue holds metallic; only with Metals::kBlack
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  float alpha_cutoff = 0.5F;
  bool double_sided = false;
  bool unlit = false;  ///< KHR_materials_unlit in the input

  bool metals_reflect = true;  ///< Metals::kDiffuse: what is metallic counts as diffuse with the base colour

  /// The share of the base colour that reflects diffusely where the metallic texture holds `metallic_texel`.
  float diffuse_share(float metallic_texel) const { return metals_reflect ? 1.0F : 1.0F - metallic * metallic_texel; }
  /// Whether its light goes into COLOR_0. What is unlit shows its base colour, and what lets all light through shows
  /// what is behind it: both stay as they are.
  bool receives() const { return !unlit && !transmission.is_clear(); }
  /// All of its textures; those not in use are empty.
  std::array<const TextureSlot*, 5> textures() const {
    return {&base_color, &emissive_texture, &metallic_roughness, &transmission.straight_texture,
            &transmission.diffuse_texture};
  }
  bool emits() const { return emissive.x > 0.0F || emissive.y > 0.0F || emissive.z > 0.0F; }
};

/// `source` none gives glTF's default material. Textures that do not change how diffuse light travels are not read.
Result<ImportedMaterial> import_material(const Document& document, const tinygltf::Model& model,
                                         std::optional<std::uint32_t> source, Metals metals, TextureLibrary& textures);

}  // namespace gltf_radiosity
