#include "plugin/shown_texture.h"

#include <cstddef>
#include <glm/common.hpp>

#include "core/mesh/tiles.h"
#include "core/photometry.h"
#include "plugin/scene_detail.h"

namespace gltf_radiosity {
namespace {

using radiosity::Rgb;
using radiosity::SubTriangle;

/// An element is looked at in the middle of this many parts squared.
constexpr std::uint32_t kCuts = 4;

/// The middle of a part of a triangle. Not all of it: what is cut off at white must not be averaged before.
SubTriangle spot_in(const SubTriangle& part) {
  const radiosity::Barycentrics middle = radiosity::middle_of(part);
  SubTriangle spot;
  for (int c = 0; c < 3; ++c) spot.corner[c] = glm::mix(middle, part.corner[c], 0.05F);
  return spot;
}

/// Squared errors of the displayed luminance, times area.
struct SquaredErrors {
  double base_color = 0.0, emissive = 0.0;
};

/// A texture multiplies both what a material emits and what it reflects, or should.
bool is_textured_lamp(const ImportedMaterial& material) {
  return (material.emissive_texture || material.base_color) && material.emits() && !material.unlit;
}

bool may_show_emissive(const ImportedMaterial& material) {
  return material.emissive_texture && material.alpha_mode == AlphaMode::kOpaque;
}

/// What both textures hold in a part of a triangle.
struct Texels {
  Rgb base_color, emissive;
};

Texels texels_in(const ImportedScene& scene, const ImportedMaterial& material, std::uint32_t triangle,
                 const SubTriangle& part) {
  return {Rgb(scene.detail->texture_mean(material.base_color, triangle, part)),
          Rgb(scene.detail->texture_mean(material.emissive_texture, triangle, part))};
}

double squared_luminance(const Rgb& light) {
  const auto luminance = double{radiosity::luminance_of(light)};
  return luminance * luminance;
}

void add_errors(const ImportedScene& scene, const ImportedMaterial& material, const radiosity::Bake& bake,
                std::uint32_t element, float white, SquaredErrors& errors) {
  const radiosity::RefinedMesh& mesh = bake.mesh;
  const std::uint32_t triangle = mesh.triangle_of_element[element];
  const SubTriangle& whole = mesh.part_of_element[element];
  const glm::uvec3& corner = mesh.elements[element];
  const Rgb irradiance = (bake.irradiance[corner.x] + bake.irradiance[corner.y] + bake.irradiance[corner.z]) / 3.0F;
  const Rgb reflected = radiosity::reflected_luminance(scene.detail->shown_reflectance(triangle, whole), irradiance);
  const Rgb emitted = shown_emission(scene.scene, triangle, whole);

  // A texture times what is divided by its mean and cut off at white, less the truth, in which each has its own.
  const Texels mean = texels_in(scene, material, triangle, whole);
  const Rgb base_color = glm::max(mean.base_color, Rgb(kDarkestTexture));
  const Rgb emissive = glm::max(mean.emissive, Rgb(kDarkestTexture));
  const double weight = double{element_area(mesh, element)} / (kCuts * kCuts);
  for (std::uint32_t k = 0; k < kCuts * kCuts; ++k) {
    const Texels here = texels_in(scene, material, triangle, spot_in(compose(whole, radiosity::tile_part(kCuts, k))));
    const Rgb truth = glm::min(here.base_color * (reflected / base_color) + here.emissive * material.emissive, white);
    const Rgb by_base_color = here.base_color * glm::min((reflected + emitted) / base_color, white);
    const Rgb by_emissive = here.emissive * glm::min(material.emissive + reflected / emissive, white);
    errors.base_color += weight * squared_luminance(by_base_color - truth);
    errors.emissive += weight * squared_luminance(by_emissive - truth);
  }
}

}  // namespace

TextureChoice choose_textures(const ImportedScene& scene, const radiosity::Bake& bake,
                              std::span<const RefinedPrimitive> refined, float white) {
  std::vector<SquaredErrors> errors(scene.materials.size());
  for (std::size_t i = 0; i < refined.size(); ++i) {
    const PrimitiveInstance& instance = scene.instances[i];
    const ImportedMaterial& material = scene.materials[instance.material];
    if (!instance.receives || !is_textured_lamp(material)) continue;
    for (const std::uint32_t element : refined[i].elements) {
      add_errors(scene, material, bake, element, white, errors[instance.material]);
    }
  }
  TextureChoice choice{std::vector<ShownTexture>(errors.size(), ShownTexture::kBaseColor)};
  for (std::size_t m = 0; m < errors.size(); ++m) {
    const bool emissive = may_show_emissive(scene.materials[m]) && errors[m].emissive < errors[m].base_color;
    if (emissive) choice.shown[m] = ShownTexture::kEmissive;
    choice.squared_error += emissive ? errors[m].emissive : errors[m].base_color;
  }
  return choice;
}

}  // namespace gltf_radiosity
