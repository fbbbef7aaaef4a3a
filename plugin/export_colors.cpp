#include "plugin/export_colors.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>

#include "core/photometry.h"
#include "plugin/scene_detail.h"

namespace gltf_radiosity {
namespace {

using radiosity::Rgb;

/// Below this a texture cannot be divided by: what is black hides a lamp whatever COLOR_0 says.
constexpr float kDarkestTexture = 1.0F / 64.0F;

/// What the functions below look at.
struct Source {
  const ImportedScene& scene;
  const radiosity::RefinedMesh& mesh;
  const PrimitiveInstance& instance;
  const ImportedMaterial& material;
  const RefinedPrimitive& refined;
};

/// The source's COLOR_0 at every output vertex.
std::vector<glm::vec4> old_colors(const Source& source) {
  std::vector<glm::vec4> colors(source.refined.vertices.size());
  const std::size_t own_count = source.refined.source_vertex_count();
  for (std::size_t v = 0; v < own_count; ++v) {
    const float* color = source.scene.vertex_colors.data() + std::size_t{source.refined.vertices[v]} * 4;
    colors[v] = {color[0], color[1], color[2], color[3]};
  }
  for (std::size_t k = 0; k < source.refined.cuts.size(); ++k) {
    const radiosity::Cut& cut = source.refined.cuts[k];
    colors[own_count + k] = glm::mix(colors[cut.ends.x], colors[cut.ends.y], cut.at);
  }
  return colors;
}

/// A third of the elements around each vertex, m2.
std::vector<float> vertex_areas(const Source& source) {
  std::vector<float> areas(source.refined.vertices.size());
  for (std::size_t t = 0; t < source.refined.triangles.size(); ++t) {
    const float third = element_area(source.mesh, source.refined.elements[t]) / 3.0F;
    for (int corner = 0; corner < 3; ++corner) areas[source.refined.triangles[t][corner]] += third;
  }
  return areas;
}

/// The mean of `value(triangle, part)` over the elements around each vertex, by area.
template <typename Value>
std::vector<Rgb> vertex_means(const Source& source, const Value& value) {
  constexpr float kTiny = 1e-30F;  // gives elements without area a say where there is nothing else
  std::vector<Rgb> sums(source.refined.vertices.size(), Rgb(0.0F));
  std::vector<float> weights(sums.size());
  for (std::size_t t = 0; t < source.refined.triangles.size(); ++t) {
    const std::uint32_t element = source.refined.elements[t];
    const float weight = element_area(source.mesh, element) + kTiny;
    const Rgb weighted = value(source.mesh.triangle_of_element[element], source.mesh.part_of_element[element]) * weight;
    for (int corner = 0; corner < 3; ++corner) {
      sums[source.refined.triangles[t][corner]] += weighted;
      weights[source.refined.triangles[t][corner]] += weight;
    }
  }
  for (std::size_t v = 0; v < sums.size(); ++v) sums[v] = weights[v] > 0.0F ? sums[v] / weights[v] : Rgb(0.0F);
  return sums;
}

/// What the surface emits at every vertex, and by how much COLOR_0 must exceed it because a texture multiplies it.
struct Emission {
  std::vector<Rgb> luminance;  ///< cd/m2; empty if the material emits nothing
  std::vector<Rgb> texture;    ///< mean base colour texture; empty without one
};

Emission emission(const Source& source, std::uint32_t instance) {
  Emission result;
  if (source.material.emissive == Rgb(0.0F)) return result;
  result.luminance = vertex_means(source, [&](std::uint32_t triangle, const radiosity::SubTriangle& part) {
    return radiosity::mean_emission(source.scene.scene, triangle, part);
  });
  if (!source.material.base_color) return result;
  result.texture = vertex_means(source, [&](std::uint32_t triangle, const radiosity::SubTriangle& part) {
    return mean_base_color_texture(source.scene, instance, triangle, part);
  });
  return result;
}

/// The share of the base colour that reflects diffusely, at every vertex; empty if that is all of it.
std::vector<Rgb> diffuse_share(const Source& source, std::uint32_t instance) {
  if (source.material.metals_reflect || source.material.metallic == 0.0F) return {};
  return vertex_means(source, [&](std::uint32_t triangle, const radiosity::SubTriangle& part) {
    return Rgb(1.0F - mean_metallic(source.scene, instance, triangle, part));
  });
}

VertexColors colors_of_instance(const Source& source, const radiosity::Bake& bake, std::uint32_t instance) {
  const std::vector<glm::vec4> old = old_colors(source);
  const std::vector<float> areas = vertex_areas(source);
  const Emission emitted = emission(source, instance);
  const std::vector<Rgb> diffuse = diffuse_share(source, instance);
  const bool keeps_alpha = source.material.alpha_mode != AlphaMode::kOpaque;
  const Rgb factor(source.material.base_color_factor);

  VertexColors colors;
  colors.unexposed.reserve(old.size());
  colors.samples.reserve(old.size());
  for (std::size_t v = 0; v < old.size(); ++v) {
    // Reflected.
    const Rgb rho = factor * Rgb(old[v]) * (diffuse.empty() ? Rgb(1.0F) : diffuse[v]);
    Rgb shown = radiosity::reflected_luminance(rho, bake.irradiance[source.refined.vertices[v]]);

    // Emitted.
    const Rgb luminance = emitted.luminance.empty() ? Rgb(0.0F) : emitted.luminance[v];
    const Rgb texture = emitted.texture.empty() ? Rgb(1.0F) : glm::max(emitted.texture[v], Rgb(kDarkestTexture));
    shown += luminance / texture;

    colors.unexposed.emplace_back(shown, keeps_alpha ? old[v].a : 1.0F);
    colors.samples.push_back({shown, areas[v], luminance != Rgb(0.0F)});
  }
  return colors;
}

}  // namespace

std::vector<VertexColors> vertex_colors(const ImportedScene& scene, const radiosity::Bake& bake,
                                        std::span<const RefinedPrimitive> refined) {
  assert(refined.size() == scene.instances.size());
  std::vector<VertexColors> colors(refined.size());
  for (std::uint32_t i = 0; i < refined.size(); ++i) {
    const PrimitiveInstance& instance = scene.instances[i];
    if (!instance.receives) continue;
    const Source source{scene, bake.mesh, instance, scene.materials[instance.material], refined[i]};
    colors[i] = colors_of_instance(source, bake, i);
  }
  return colors;
}

std::size_t export_color_accessor(Document& document, BufferBuilder& buffer, const VertexColors& colors,
                                  std::span<const std::uint32_t> kept, float k, ColorType type) {
  // Expose and clamp; what is no number becomes black.
  const auto clamped = [](float value) { return value > 0.0F ? std::min(value, 1.0F) : 0.0F; };
  std::vector<float> values;
  values.reserve(colors.unexposed.size() * 4);
  for (const glm::vec4& color : colors.unexposed) {
    for (int band = 0; band < 3; ++band) values.push_back(clamped(color[band] * k));
    values.push_back(clamped(color.a));
  }

  // Store.
  const ComponentType component = type == ColorType::kFloat ? ComponentType::kF32
                                  : type == ColorType::kU16 ? ComponentType::kU16
                                                            : ComponentType::kU8;
  const bool normalized = type != ColorType::kFloat;
  const RawAccessor raw{component, 4, normalized, colors.unexposed.size(),
                        encode_floats(values, component, normalized)};
  return append_accessor(document, buffer, picked(raw, kept), BufferTarget::kVertices);
}

}  // namespace gltf_radiosity
