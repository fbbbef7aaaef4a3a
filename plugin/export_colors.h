// Irradiance at vertices -> COLOR_0.
//
//   with a base colour texture:  COLOR_0 = k (H / pi) x factor x old COLOR_0 + k Le / texture
//   without:                     COLOR_0 = k (rho H / pi + Le)
//
// so that an engine which shows COLOR_0 x baseColorFactor (1) x texture, unlit, shows k (rho H / pi + Le). Where the
// material's emissive texture is shown (shown_texture.h) it is the other way round, the emission exact and the base
// colour texture a mean around the vertex:
//
//   COLOR_0 = k (H / pi) x factor x old COLOR_0 x base colour texture / texture + k Le / texture
//
// Where the material stays lit (--target keep) it keeps its base colour and its emission: COLOR_0 = k (H / pi) x old
// COLOR_0.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/bake.h"
#include "core/reconstruct/exposure.h"
#include "core/rgb.h"
#include "plugin/append_accessor.h"
#include "plugin/export_meshes.h"
#include "plugin/import_scene.h"
#include "plugin/shown_texture.h"

namespace gltf_radiosity {

/// Per output vertex of one primitive instance.
struct VertexColors {
  std::vector<glm::vec4> unexposed;  ///< what COLOR_0 holds at k = 1, cd/m2; alpha as in the source
  /// What has to fit into [0,1]: `unexposed`, which with a texture is brighter than what is displayed.
  std::vector<radiosity::ExposureSample> samples;
  std::vector<std::uint32_t> places;  ///< a number for each position: vertices at one place are dithered alike
  /// The share of the light that `unexposed` shows beside what is emitted, its texture apart; none if it varies.
  std::optional<radiosity::Rgb> reflectance{};
  bool emits = false;
};

/// What COLOR_0 holds beside the light.
struct ColorParts {
  bool base_color = true;  ///< the material's factor and what is metallic
  bool emission = true;
};

/// [refined.size()], empty entries for instances that do not receive. `textures` is [scene.materials.size()], or empty
/// if all show that of their base colour.
std::vector<VertexColors> vertex_colors(const ImportedScene& scene, const radiosity::Bake& bake,
                                        std::span<const RefinedPrimitive> refined, const ColorParts& parts = {},
                                        std::span<const ShownTexture> textures = {});

/// What COLOR_0 is made of at each output vertex of an instance, kept or not, whatever the light:
/// undyed x base colour factor x H / pi + emission.
struct ColorTerms {
  std::vector<radiosity::Rgb> undyed;
  std::vector<radiosity::Rgb> emission;  ///< before it is dimmed, cd/m2
  std::vector<float> alpha, areas;       ///< areas in m2
  std::vector<std::uint32_t> places;     ///< as in VertexColors
};
ColorTerms color_terms(const ImportedScene& scene, const radiosity::Bake& bake, const RefinedPrimitive& refined,
                       std::uint32_t instance, const ColorParts& parts, ShownTexture texture);

// Of a primitive that was simplified only the vertices `kept` are written (RefinedPrimitive); all if that is empty.

/// The brightest of each band at exposure k, within [2^-16, 1]; 1 where a band is black.
radiosity::Rgb brightest(const VertexColors& colors, std::span<const std::uint32_t> kept, float k);

/// What an exposure is chosen by, of all primitives.
std::vector<radiosity::ExposureSample> samples_of(const std::vector<VertexColors>& colors);

/// k x colours clamped to [0,1], RGBA.
RawAccessor color_rows(const VertexColors& colors, const radiosity::Rgb& k, ColorType type);
/// k x colours, floats without a limit, RGB.
RawAccessor radiance_rows(const VertexColors& colors, float k);

/// Appends an accessor with k x colours clamped to [0,1] and returns its index. 8 bits are dithered: by less than a
/// step, and what lies on a step stays.
std::size_t export_color_accessor(Document& document, BufferBuilder& buffer, const VertexColors& colors,
                                  std::span<const std::uint32_t> kept, const radiosity::Rgb& k, ColorType type);

/// Keeps the reflectance as long as it is the same at every vertex.
void add_reflectance(const radiosity::Rgb& rho, bool is_first, VertexColors& colors);

/// The share of one light group in `vertex_colors` of an instance. REQUIRES: bake.group_irradiance.
VertexColors group_colors(const ImportedScene& scene, const radiosity::Bake& bake, const RefinedPrimitive& refined,
                          std::uint32_t instance, const ColorParts& parts, ShownTexture texture, std::uint32_t group);

/// Appends an accessor with k x colours without alpha, floats without a limit, and returns its index.
std::size_t export_light_accessor(Document& document, BufferBuilder& buffer, const VertexColors& colors,
                                  std::span<const std::uint32_t> kept, const radiosity::Rgb& k, ColorType type);

/// Notes what turns COLOR_0 into illuminance, so that a page can show it (plugin/page/illuminance.js): `reflectance`
/// and `emits` into the primitive's extras.radiosity.
void note_reflectance(const VertexColors& colors, Json& primitive);

/// "_NAME" for options.radiance_attribute, with or without its underscore.
std::string radiance_semantic(const Options& options);

/// Appends an accessor with k x colours, floats without a limit, and returns its index.
std::size_t export_radiance_accessor(Document& document, BufferBuilder& buffer, const VertexColors& colors,
                                     std::span<const std::uint32_t> kept, float k);

/// An error if the file has an attribute of the name already.
Result<Done> check_attribute_is_free(const Document& document, const ImportedScene& scene, const Options& options);

}  // namespace gltf_radiosity
