// Which of a material's textures multiplies COLOR_0 in the output.
//
// Unlit materials show one texture. Where a screen glows brighter than the room that it reflects, its picture should
// stay sharp, and what it reflects be as fine as the vertices are; elsewhere it is the other way round.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/bake.h"
#include "plugin/export_meshes.h"
#include "plugin/import_scene.h"

namespace gltf_radiosity {

enum class ShownTexture : std::uint8_t { kBaseColor, kEmissive };

/// Below this a texture cannot be divided by: what is black hides what it multiplies whatever COLOR_0 says.
inline constexpr float kDarkestTexture = 1.0F / 64.0F;

struct TextureChoice {
  std::vector<ShownTexture> shown;  ///< [scene.materials.size()]
  /// What is wrong of the displayed luminance because it is one texture, or multiplies what is white: squared, over all
  /// elements of materials that emit, (cd/m2)^2 m2.
  double squared_error = 0.0;
};

/// The texture with which less of the displayed luminance is wrong, as mean square over the elements of all instances.
/// What is brighter than `white` (cd/m2) is cut off, so a lamp may be white whatever its texture. The emissive one only
/// of opaque materials, for the other has the alpha.
TextureChoice choose_textures(const ImportedScene& scene, const radiosity::Bake& bake,
                              std::span<const RefinedPrimitive> refined, float white);

}  // namespace gltf_radiosity
