// Irradiance at vertices -> COLOR_0.
//
//   with a base colour texture:  COLOR_0 = k (H / pi) x factor x old COLOR_0 + k Le / texture
//   without:                     COLOR_0 = k (rho H / pi + Le)
//
// so that an engine which shows COLOR_0 x baseColorFactor (1) x texture, unlit, shows k (rho H / pi + Le).
#pragma once

#include <cstddef>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "core/bake.h"
#include "core/reconstruct/exposure.h"
#include "plugin/append_accessor.h"
#include "plugin/export_meshes.h"
#include "plugin/import_scene.h"

namespace gltf_radiosity {

/// Per output vertex of one primitive instance.
struct VertexColors {
  std::vector<glm::vec4> unexposed;  ///< what COLOR_0 holds at k = 1, cd/m2; alpha as in the source
  /// What has to fit into [0,1]: `unexposed`, which with a texture is brighter than what is displayed.
  std::vector<radiosity::ExposureSample> samples;
};

/// [refined.size()], empty entries for instances that do not receive.
std::vector<VertexColors> vertex_colors(const ImportedScene& scene, const radiosity::Bake& bake,
                                        std::span<const RefinedPrimitive> refined);

/// Appends an accessor with k x colours clamped to [0,1] and returns its index. Only the vertices `kept` are written,
/// all if that is empty.
std::size_t export_color_accessor(Document& document, BufferBuilder& buffer, const VertexColors& colors,
                                  std::span<const std::uint32_t> kept, float k, ColorType type);

}  // namespace gltf_radiosity
