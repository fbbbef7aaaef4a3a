// glTF materials -> how surfaces reflect, emit and let light through.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/scene.h"
#include "plugin/document.h"
#include "plugin/import_textures.h"

namespace gltf_radiosity {

enum class AlphaMode { kOpaque, kMask, kBlend };

/// A glTF material as light sees it. Colours are linear Rec. 709.
struct ImportedMaterial {
  std::optional<std::uint32_t> source;  ///< index in the document's materials; none for the default material
  glm::vec4 base_color_factor{1.0F};
  TextureSlot base_color;               ///< sRGB; unused slots answer white
  glm::vec3 emissive{0.0F};             ///< factor times KHR_materials_emissive_strength, cd/m2
  TextureSlot emissive_texture;         ///< sRGB
  float metallic = 1.0F;
  TextureSlot metallic_roughness;       ///< blue holds metallic
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  float alpha_cutoff = 0.5F;
  bool double_sided = false;
  bool unlit = false;                   ///< KHR_materials_unlit in the input
};

/// `source` none gives glTF's default material.
Result<ImportedMaterial> import_material(const Document& document, const tinygltf::Model& model, std::optional<std::uint32_t> source, TextureLibrary& textures);

}  // namespace gltf_radiosity
