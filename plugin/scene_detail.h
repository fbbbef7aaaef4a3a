// What varies over the surfaces of an imported scene: textures and vertex colours.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "core/scene.h"
#include "plugin/import_materials.h"

namespace gltf_radiosity {

struct ImportedScene;

/// Immutable once filled; every method may be called from several threads at once. A mean of a product (texture times
/// vertex colour) is taken as the product of the means.
class SceneDetail : public radiosity::SurfaceDetail {
 public:
  // Views of an ImportedScene's vectors, which must outlive this and keep their memory (they may be moved).
  std::span<const glm::uvec3> triangles;
  std::span<const std::uint32_t> surface_of_triangle;
  std::span<const float> vertex_colors;  ///< [vertex_count * 4]
  std::span<const ImportedMaterial> materials;
  // Its own.
  std::vector<std::uint32_t> material_of_surface;
  std::vector<std::uint8_t> surface_has_colors;  ///< 1 where COLOR_0 multiplies the surface
  std::vector<std::vector<glm::vec2>>
      texcoords;  ///< by set; [vertex_count] each, or empty where no material asks for it

  /// What is reflected of the light that no ray carries through: mean base colour, less what is transmitted.
  radiosity::Rgb reflectance(std::uint32_t triangle, const radiosity::SubTriangle& part) const override;
  radiosity::Rgb undyed_reflectance(std::uint32_t triangle, const radiosity::SubTriangle& part) const override;
  radiosity::Rgb emission(std::uint32_t triangle, const radiosity::SubTriangle& part) const override;
  float opacity(std::uint32_t triangle, radiosity::Barycentrics at) const override;

  /// Mean of what the surface shows of white light when it is baked: the base colour that reflects diffusely. What is
  /// transmitted is not taken off, for an unlit material knows no transmission.
  radiosity::Rgb shown_reflectance(std::uint32_t triangle, const radiosity::SubTriangle& part) const;
  /// COLOR_0 at a point, linear RGBA; white where the surface has none.
  glm::vec4 vertex_color(std::uint32_t triangle, radiosity::Barycentrics at) const;
  /// What an engine that knows no light shows at a point: base colour factor times texture times COLOR_0, linear.
  radiosity::Rgb unlit_color(std::uint32_t triangle, radiosity::Barycentrics at) const;
  /// Mean of a texture of the triangle's material over a part of it, linear RGBA; white for an empty slot.
  glm::vec4 texture_mean(const TextureSlot& slot, std::uint32_t triangle, const radiosity::SubTriangle& part) const;

 private:
  const ImportedMaterial& material_of(std::uint32_t triangle) const;
  /// shown_reflectance() less the base colour factor.
  radiosity::Rgb undyed_shown(std::uint32_t triangle, const radiosity::SubTriangle& part) const;
  /// The share of the base colour that reflects diffusely, mean over a part.
  float diffuse_share(std::uint32_t triangle, const radiosity::SubTriangle& part) const;
  /// A texture of the triangle's material at a point, linear RGBA; white for an empty slot.
  glm::vec4 texel(const TextureSlot& slot, std::uint32_t triangle, radiosity::Barycentrics at) const;
  glm::vec2 texcoord(int set, std::uint32_t triangle, radiosity::Barycentrics at) const;
};

/// Mean of the base colour *texture*, without factors, over a part of a scene triangle; linear, white without a
/// texture.
glm::vec3 mean_base_color_texture(const ImportedScene& scene, std::uint32_t instance, std::uint32_t triangle,
                                  const radiosity::SubTriangle& part);

/// Mean of metallic, factor times texture, over a part of a scene triangle. REQUIRES: imported with Metals::kBlack.
float mean_metallic(const ImportedScene& scene, std::uint32_t instance, std::uint32_t triangle,
                    const radiosity::SubTriangle& part);

}  // namespace gltf_radiosity
