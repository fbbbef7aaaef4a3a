#include "plugin/scene_detail.h"

#include "plugin/import_scene.h"

namespace gltf_radiosity {

using radiosity::Barycentrics;
using radiosity::Rgb;
using radiosity::SubTriangle;

const ImportedMaterial& SceneDetail::material_of(std::uint32_t triangle) const {
  return materials[material_of_surface[surface_of_triangle[triangle]]];
}

glm::vec2 SceneDetail::texcoord(int set, std::uint32_t triangle, Barycentrics at) const {
  const auto index = static_cast<std::size_t>(set);
  if (index >= texcoords.size() || texcoords[index].empty()) return glm::vec2(0.0F);
  const std::vector<glm::vec2>& uv = texcoords[index];
  const glm::uvec3& corners = triangles[triangle];
  return uv[corners.x] * (1.0F - at.x - at.y) + uv[corners.y] * at.x + uv[corners.z] * at.y;
}

glm::vec4 SceneDetail::vertex_color(std::uint32_t triangle, Barycentrics at) const {
  if (surface_has_colors[surface_of_triangle[triangle]] == 0) return glm::vec4(1.0F);
  const float weight[3] = {1.0F - at.x - at.y, at.x, at.y};
  glm::vec4 sum(0.0F);
  for (int corner = 0; corner < 3; ++corner) {
    const float* rgba = vertex_colors.data() + std::size_t{triangles[triangle][corner]} * 4;
    sum += glm::vec4(rgba[0], rgba[1], rgba[2], rgba[3]) * weight[corner];
  }
  return sum;
}

Rgb SceneDetail::unlit_color(std::uint32_t triangle, Barycentrics at) const {
  const ImportedMaterial& material = material_of(triangle);
  return Rgb(material.base_color_factor * texel(material.base_color, triangle, at) * vertex_color(triangle, at));
}

glm::vec4 SceneDetail::texel(const TextureSlot& slot, std::uint32_t triangle, Barycentrics at) const {
  return slot ? slot.at(texcoord(slot.texcoord, triangle, at)) : glm::vec4(1.0F);
}

glm::vec4 SceneDetail::texture_mean(const TextureSlot& slot, std::uint32_t triangle, const SubTriangle& part) const {
  if (!slot) return glm::vec4(1.0F);
  return slot.mean({texcoord(slot.texcoord, triangle, part.corner[0]),
                    texcoord(slot.texcoord, triangle, part.corner[1]),
                    texcoord(slot.texcoord, triangle, part.corner[2])});
}

float SceneDetail::diffuse_share(std::uint32_t triangle, const SubTriangle& part) const {
  const ImportedMaterial& material = material_of(triangle);
  if (material.metals_reflect) return 1.0F;  // whatever the texture says: reading it is half of the work
  return material.diffuse_share(texture_mean(material.metallic_roughness, triangle, part).z);
}

Rgb SceneDetail::shown_reflectance(std::uint32_t triangle, const SubTriangle& part) const {
  const ImportedMaterial& material = material_of(triangle);
  if (material.unlit) return Rgb(0.0F);
  // Linear in between, so the mean is the value at the middle.
  const Barycentrics middle = (part.corner[0] + part.corner[1] + part.corner[2]) / 3.0F;
  const glm::vec4 mean =
      material.base_color_factor * texture_mean(material.base_color, triangle, part) * vertex_color(triangle, middle);
  return Rgb(mean) * diffuse_share(triangle, part);
}

Rgb SceneDetail::undyed_shown(std::uint32_t triangle, const SubTriangle& part) const {
  const ImportedMaterial& material = material_of(triangle);
  const Barycentrics middle = (part.corner[0] + part.corner[1] + part.corner[2]) / 3.0F;
  return Rgb(texture_mean(material.base_color, triangle, part) * vertex_color(triangle, middle)) *
         diffuse_share(triangle, part);
}

// What a material lets through depends on its factor: there is no other that it is in proportion to.
Rgb SceneDetail::undyed_reflectance(std::uint32_t triangle, const SubTriangle& part) const {
  const ImportedMaterial& material = material_of(triangle);
  return material.unlit || material.transmission ? Rgb(0.0F) : undyed_shown(triangle, part);
}

Rgb SceneDetail::reflectance(std::uint32_t triangle, const SubTriangle& part) const {
  const ImportedMaterial& material = material_of(triangle);
  const Rgb shown = shown_reflectance(triangle, part);
  if (material.unlit || !material.transmission) return shown;
  const float straight = texture_mean(material.transmission.straight_texture, triangle, part).x;
  const float diffuse = texture_mean(material.transmission.diffuse_texture, triangle, part).w;
  const Transmission::Shares shares = material.transmission.shares(shown, straight, diffuse);
  return shares.passes < 1.0F ? shown * (shares.reflects / (1.0F - shares.passes)) : Rgb(0.0F);
}

Rgb SceneDetail::emission(std::uint32_t triangle, const SubTriangle& part) const {
  const ImportedMaterial& material = material_of(triangle);
  if (material.unlit || !material.emits()) return Rgb(0.0F);
  return (material.emissive + material.dimmed) * Rgb(texture_mean(material.emissive_texture, triangle, part));
}

float SceneDetail::opacity(std::uint32_t triangle, Barycentrics at) const {
  const ImportedMaterial& material = material_of(triangle);
  const glm::vec4 color =
      material.base_color_factor * vertex_color(triangle, at) * texel(material.base_color, triangle, at);
  float coverage = 1.0F;
  if (material.alpha_mode == AlphaMode::kMask) coverage = color.w < material.alpha_cutoff ? 0.0F : 1.0F;
  if (material.alpha_mode == AlphaMode::kBlend) coverage = color.w;
  if (material.unlit || !material.transmission) return coverage;
  const Transmission& through = material.transmission;
  return coverage * (1.0F - through
                                .shares(color, texel(through.straight_texture, triangle, at).x,
                                        texel(through.diffuse_texture, triangle, at).w)
                                .passes);
}

glm::vec3 mean_base_color_texture(const ImportedScene& scene, std::uint32_t instance, std::uint32_t triangle,
                                  const SubTriangle& part) {
  const ImportedMaterial& material = scene.materials[scene.instances[instance].material];
  return glm::vec3(scene.detail->texture_mean(material.base_color, triangle, part));
}

float mean_metallic(const ImportedScene& scene, std::uint32_t instance, std::uint32_t triangle,
                    const SubTriangle& part) {
  const ImportedMaterial& material = scene.materials[scene.instances[instance].material];
  return material.metallic * scene.detail->texture_mean(material.metallic_roughness, triangle, part).z;
}

}  // namespace gltf_radiosity
