// glTF materials -> how surfaces reflect, emit and let light through.
#pragma once

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

/// A glTF material as light sees it. Colours are linear Rec. 709.
struct ImportedMaterial {
  std::optional<std::uint32_t> source;  ///< index in the document's materials; none for the default material
  glm::vec4 base_color_factor{1.0F};
  TextureSlot base_color;        ///< sRGB; unused slots answer white
  glm::vec3 emissive{0.0F};      ///< factor times KHR_materials_emissive_strength, cd/m2
  TextureSlot emissive_texture;  ///< sRGB; empty if `emissive` is black
  float metallic = 1.0F;
  TextureSlot metallic_roughness;  ///< blue holds metallic; only with Metals::kBlack
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  float alpha_cutoff = 0.5F;
  bool double_sided = false;
  bool unlit = false;  ///< KHR_materials_unlit in the input

  bool metals_reflect = true;  ///< Metals::kDiffuse: what is metallic counts as diffuse with the base colour

  /// The share of the base colour that reflects diffusely where the metallic texture holds `metallic_texel`.
  float diffuse_share(float metallic_texel) const { return metals_reflect ? 1.0F : 1.0F - metallic * metallic_texel; }
  bool emits() const { return emissive.x > 0.0F || emissive.y > 0.0F || emissive.z > 0.0F; }
};

/// `source` none gives glTF's default material. Textures that do not change how diffuse light travels are not read.
Result<ImportedMaterial> import_material(const Document& document, const tinygltf::Model& model,
                                         std::optional<std::uint32_t> source, Metals metals, TextureLibrary& textures,
                                         std::vector<Warning>& warnings);

}  // namespace gltf_radiosity
