#include "plugin/export_colors.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>

#include "core/photometry.h"
#include "core/random.h"
#include "plugin/our_extras.h"
#include "plugin/scene_detail.h"

namespace gltf_radiosity {
namespace {

using radiosity::Rgb;

/// What the functions below look at.
struct Source {
  const ImportedScene& scene;
  const radiosity::RefinedMesh& mesh;
  const PrimitiveInstance& instance;
  const ImportedMaterial& material;
  const RefinedPrimitive& refined;
  const ColorParts& parts;
  ShownTexture texture;
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

/// What the surface emits at every vertex before it is dimmed, and by how much COLOR_0 must exceed it because a texture
/// multiplies it.
struct Emission {
  std::vector<Rgb> luminance;  ///< cd/m2; empty if the material emits nothing
  std::vector<Rgb> texture;    ///< mean base colour texture; empty without one
};

Emission emission(const Source& source, std::uint32_t instance) {
  Emission result;
  if (source.material.emissive == Rgb(0.0F) || !source.parts.emission) return result;
  if (source.texture == ShownTexture::kEmissive) {
    result.luminance.assign(source.refined.vertices.size(), source.material.emissive + source.material.dimmed);
    return result;
  }
  result.luminance = vertex_means(source, [&](std::uint32_t triangle, const radiosity::SubTriangle& part) {
    return radiosity::mean_emission(source.scene.scene, triangle, part);
  });
  if (!source.material.base_color) return result;
  result.texture = vertex_means(source, [&](std::uint32_t triangle, const radiosity::SubTriangle& part) {
    return mean_base_color_texture(source.scene, instance, triangle, part);
  });
  return result;
}

/// By how much COLOR_0 must exceed the light that a white surface would reflect, at every vertex, because the emissive
/// texture multiplies it and not the base colour's; empty if that is nothing.
std::vector<Rgb> base_color_over_emissive(const Source& source) {
  if (source.texture == ShownTexture::kBaseColor) return {};
  return vertex_means(source, [&](std::uint32_t triangle, const radiosity::SubTriangle& part) {
    const SceneDetail& detail = *source.scene.detail;
    return Rgb(detail.texture_mean(source.material.base_color, triangle, part)) /
           glm::max(Rgb(detail.texture_mean(source.material.emissive_texture, triangle, part)), Rgb(kDarkestTexture));
  });
}

/// The share of the base colour that reflects diffusely, at every vertex; empty if that is all of it.
std::vector<Rgb> diffuse_share(const Source& source, std::uint32_t instance) {
  if (!source.parts.base_color || source.material.metals_reflect || source.material.metallic == 0.0F) return {};
  return vertex_means(source, [&](std::uint32_t triangle, const radiosity::SubTriangle& part) {
    return Rgb(1.0F - mean_metallic(source.scene, instance, triangle, part));
  });
}

/// The same number for vertices at one position.
std::uint32_t number_of(const glm::vec3& position) {
  const glm::vec3 p = position + 0.0F;  // -0 is 0
  const auto low = std::uint64_t{std::bit_cast<std::uint32_t>(p.x)};
  const auto high = std::uint64_t{std::bit_cast<std::uint32_t>(p.y)};
  radiosity::Random random(high << 32U | low, std::bit_cast<std::uint32_t>(p.z));
  random.bits();  // the first one depends on little more than the sum of both
  return random.bits();
}

/// By what the emission of an instance is dimmed.
Rgb dimmer_of_emission(const Source& source) {
  const radiosity::Scene& scene = source.scene.scene;
  const std::uint32_t surface = scene.surface_of_triangle[source.instance.first_triangle];
  return radiosity::dimmer_of(scene, scene.surfaces[surface].light_group);
}

ColorTerms terms_of_instance(const Source& source, std::uint32_t instance) {
  const std::vector<glm::vec4> old = old_colors(source);
  const Emission emitted = emission(source, instance);
  const std::vector<Rgb> diffuse = diffuse_share(source, instance), blurred = base_color_over_emissive(source);
  const bool keeps_alpha = source.material.alpha_mode != AlphaMode::kOpaque;
  ColorTerms terms;
  terms.areas = vertex_areas(source);
  for (std::size_t v = 0; v < old.size(); ++v) {
    terms.undyed.push_back(Rgb(old[v]) * (diffuse.empty() ? Rgb(1.0F) : diffuse[v]) *
                           (blurred.empty() ? Rgb(1.0F) : blurred[v]));
    const Rgb luminance = emitted.luminance.empty() ? Rgb(0.0F) : emitted.luminance[v];
    const Rgb texture = emitted.texture.empty() ? Rgb(1.0F) : glm::max(emitted.texture[v], Rgb(kDarkestTexture));
    terms.emission.push_back(luminance / texture);
    terms.alpha.push_back(keeps_alpha ? old[v].a : 1.0F);
    terms.places.push_back(number_of(source.mesh.positions[source.refined.vertices[v]]));
  }
  return terms;
}

/// `irradiance` is that of all vertices of the refined mesh, lx.
VertexColors colors_of_instance(const Source& source, std::span<const Rgb> irradiance, std::uint32_t instance) {
  const std::vector<glm::vec4> old = old_colors(source);
  const std::vector<float> areas = vertex_areas(source);
  const Emission emitted = emission(source, instance);
  const std::vector<Rgb> diffuse = diffuse_share(source, instance);
  const std::vector<Rgb> blurred = base_color_over_emissive(source);
  const bool keeps_alpha = source.material.alpha_mode != AlphaMode::kOpaque;
  const Rgb dimmer = dimmer_of_emission(source);
  const Rgb factor = source.parts.base_color ? Rgb(source.material.base_color_factor) : Rgb(1.0F);

  VertexColors colors;
  colors.unexposed.reserve(old.size());
  colors.samples.reserve(old.size());
  colors.places.reserve(old.size());
  for (std::size_t v = 0; v < old.size(); ++v) {
    // Reflected.
    const Rgb rho =
        factor * Rgb(old[v]) * (diffuse.empty() ? Rgb(1.0F) : diffuse[v]) * (blurred.empty() ? Rgb(1.0F) : blurred[v]);
    Rgb shown = radiosity::reflected_luminance(rho, irradiance[source.refined.vertices[v]]);

    // Emitted.
    const Rgb luminance = emitted.luminance.empty() ? Rgb(0.0F) : emitted.luminance[v] * dimmer;
    const Rgb texture = emitted.texture.empty() ? Rgb(1.0F) : glm::max(emitted.texture[v], Rgb(kDarkestTexture));
    shown += luminance / texture;

    add_reflectance(source.parts.base_color ? rho : rho * Rgb(source.material.base_color_factor), v == 0, colors);
    colors.emits = colors.emits || luminance != Rgb(0.0F);
    colors.unexposed.emplace_back(shown, keeps_alpha ? old[v].a : 1.0F);
    colors.samples.push_back({shown, areas[v], luminance != Rgb(0.0F)});
    colors.places.push_back(number_of(source.mesh.positions[source.refined.vertices[v]]));
  }
  return colors;
}

/// What is no number is black.
float in_unit_range(float value) { return value > 0.0F ? std::min(value, 1.0F) : 0.0F; }

ComponentType component_of(ColorType type) {
  return type == ColorType::kFloat ? ComponentType::kF32
         : type == ColorType::kU16 ? ComponentType::kU16
                                   : ComponentType::kU8;
}

/// Moves the bands of RGBA colours, [places.size() * 4], by up to half a step of 8 bits.
void dither(std::vector<float>& values, std::span<const std::uint32_t> places) {
  constexpr float kStep = 1.0F / 255.0F;
  for (std::size_t v = 0; v < places.size(); ++v) {
    radiosity::Random random(places[v], 0);
    for (std::size_t band = 0; band < 3; ++band) {
      float& value = values[4 * v + band];
      const float steps = value / kStep;
      const float whole = std::floor(steps);
      value = (steps - whole > random.share() ? whole + 1.0F : whole) * kStep;
    }
  }
}

}  // namespace

std::vector<VertexColors> vertex_colors(const ImportedScene& scene, const radiosity::Bake& bake,
                                        std::span<const RefinedPrimitive> refined, const ColorParts& parts,
                                        std::span<const ShownTexture> textures) {
  assert(refined.size() == scene.instances.size());
  std::vector<VertexColors> colors(refined.size());
  for (std::uint32_t i = 0; i < refined.size(); ++i) {
    const PrimitiveInstance& instance = scene.instances[i];
    if (!instance.receives) continue;
    const ShownTexture texture = textures.empty() ? ShownTexture::kBaseColor : textures[instance.material];
    const Source source{scene, bake.mesh, instance, scene.materials[instance.material], refined[i], parts, texture};
    colors[i] = colors_of_instance(source, bake.irradiance, i);
  }
  return colors;
}

ColorTerms color_terms(const ImportedScene& scene, const radiosity::Bake& bake, const RefinedPrimitive& refined,
                       std::uint32_t instance, const ColorParts& parts, ShownTexture texture) {
  const PrimitiveInstance& own = scene.instances[instance];
  return terms_of_instance({scene, bake.mesh, own, scene.materials[own.material], refined, parts, texture}, instance);
}

Rgb brightest(const VertexColors& colors, std::span<const std::uint32_t> kept, float k) {
  constexpr float kLeast = 0x1p-16F;
  Rgb most(0.0F);
  const auto look_at = [&](const glm::vec4& color) {
    for (int band = 0; band < 3; ++band) most[band] = std::max(most[band], in_unit_range(color[band] * k));
  };
  if (kept.empty()) std::ranges::for_each(colors.unexposed, look_at);
  for (const std::uint32_t vertex : kept) look_at(colors.unexposed[vertex]);
  for (int band = 0; band < 3; ++band) most[band] = most[band] > 0.0F ? std::max(most[band], kLeast) : 1.0F;
  return most;
}

VertexColors group_colors(const ImportedScene& scene, const radiosity::Bake& bake, const RefinedPrimitive& refined,
                          std::uint32_t instance, const ColorParts& parts, ShownTexture texture, std::uint32_t group) {
  const PrimitiveInstance& own = scene.instances[instance];
  const std::uint32_t surface = scene.scene.surface_of_triangle[own.first_triangle];
  const ColorParts shown{parts.base_color, parts.emission && scene.scene.surfaces[surface].light_group == group};
  return colors_of_instance({scene, bake.mesh, own, scene.materials[own.material], refined, shown, texture},
                            bake.group_irradiance[group], instance);
}

std::vector<radiosity::ExposureSample> samples_of(const std::vector<VertexColors>& colors) {
  std::vector<radiosity::ExposureSample> samples;
  for (const VertexColors& primitive : colors) {
    samples.insert(samples.end(), primitive.samples.begin(), primitive.samples.end());
  }
  return samples;
}

RawAccessor color_rows(const VertexColors& colors, const Rgb& k, ColorType type) {
  // Expose and clamp.
  std::vector<float> values;
  values.reserve(colors.unexposed.size() * 4);
  for (const glm::vec4& color : colors.unexposed) {
    for (int band = 0; band < 3; ++band) values.push_back(in_unit_range(color[band] * k[band]));
    values.push_back(in_unit_range(color.a));
  }
  if (type == ColorType::kU8) dither(values, colors.places);

  // Store.
  const ComponentType component = component_of(type);
  const bool normalized = type != ColorType::kFloat;
  return {component, 4, normalized, colors.unexposed.size(), encode_floats(values, component, normalized)};
}

std::size_t export_color_accessor(Document& document, BufferBuilder& buffer, const VertexColors& colors,
                                  std::span<const std::uint32_t> kept, const Rgb& k, ColorType type) {
  return append_accessor(document, buffer, picked(color_rows(colors, k, type), kept), BufferTarget::kVertices);
}

std::size_t export_light_accessor(Document& document, BufferBuilder& buffer, const VertexColors& colors,
                                  std::span<const std::uint32_t> kept, const Rgb& k, ColorType type) {
  const bool normalized = type != ColorType::kFloat;
  std::vector<float> values;
  values.reserve(colors.unexposed.size() * 3);
  for (const glm::vec4& color : colors.unexposed) {
    for (int band = 0; band < 3; ++band) {
      const float value = color[band] * k[band];
      values.push_back(normalized ? in_unit_range(value) : value);
    }
  }
  const ComponentType component = component_of(type);
  const RawAccessor raw{component, 3, normalized, colors.unexposed.size(),
                        encode_floats(values, component, normalized)};
  return append_accessor(document, buffer, picked(raw, kept), BufferTarget::kVertices);
}

void add_reflectance(const Rgb& rho, bool is_first, VertexColors& colors) {
  if (is_first) colors.reflectance = rho;
  if (colors.reflectance && *colors.reflectance != rho) colors.reflectance.reset();
}

void note_reflectance(const VertexColors& colors, Json& primitive) {
  if (!colors.reflectance && !colors.emits) return;
  const auto six_digits = [](float value) { return std::round(static_cast<double>(value) * 1e6) / 1e6; };
  Json& note = our_extras(primitive);
  if (const auto& rho = colors.reflectance) {
    note["reflectance"] = {six_digits(rho->r), six_digits(rho->g), six_digits(rho->b)};
  }
  if (colors.emits) note["emits"] = true;
}

std::string radiance_semantic(const Options& options) {
  return options.radiance_attribute.starts_with('_') ? options.radiance_attribute : "_" + options.radiance_attribute;
}

RawAccessor radiance_rows(const VertexColors& colors, float k) {
  std::vector<float> values;
  values.reserve(colors.unexposed.size() * 3);
  for (const glm::vec4& color : colors.unexposed) {
    for (int band = 0; band < 3; ++band) values.push_back(color[band] * k);
  }
  return {ComponentType::kF32, 3, false, colors.unexposed.size(), encode_floats(values, ComponentType::kF32, false)};
}

std::size_t export_radiance_accessor(Document& document, BufferBuilder& buffer, const VertexColors& colors,
                                     std::span<const std::uint32_t> kept, float k) {
  return append_accessor(document, buffer, picked(radiance_rows(colors, k), kept), BufferTarget::kVertices);
}

Result<Done> check_attribute_is_free(const Document& document, const ImportedScene& scene, const Options& options) {
  if (options.radiance_attribute.empty()) return Done{};
  const std::string semantic = radiance_semantic(options);
  for (const PrimitiveInstance& instance : scene.instances) {
    const Json& primitive = document.json["meshes"][instance.mesh]["primitives"][instance.primitive];
    if (!instance.receives || !primitive["attributes"].contains(semantic)) continue;
    return Error{ErrorCode::kBadOption, "--radiance-attribute",
                 place_of_primitive(instance.mesh, instance.primitive) + " has an attribute " + semantic + " already"};
  }
  return Done{};
}

}  // namespace gltf_radiosity
