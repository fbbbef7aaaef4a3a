// The refined mesh -> glTF accessors, one set per primitive instance.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/mesh/refined_mesh.h"
#include "plugin/append_accessor.h"
#include "plugin/document.h"
#include "plugin/import_scene.h"
#include "plugin/interpolate_attributes.h"

namespace gltf_radiosity {

/// One primitive instance of the refined mesh in its own numbering.
struct RefinedPrimitive {
  bool changed = false;  ///< false: vertices and indices are the source's, only COLOR_0 is new
  std::vector<std::uint32_t>
      vertices;                      ///< RefinedMesh vertex of each output vertex; the scene's own come first, in order
  std::vector<radiosity::Cut> cuts;  ///< where each of the others is, between output vertices before it
  std::vector<glm::uvec3> triangles;    ///< output vertices, wound as glTF wants them in the node's space
  std::vector<std::uint32_t> elements;  ///< RefinedMesh element of each triangle
  /// Once simplified (simplify_scene.h): the output vertices that are written, ascending, and what `triangles` counts
  /// in. Empty: all.
  std::vector<std::uint32_t> kept;

  std::size_t source_vertex_count() const { return vertices.size() - cuts.size(); }
  std::size_t written_vertex_count() const { return kept.empty() ? vertices.size() : kept.size(); }
};

/// An attribute at every output vertex, written or not: the source's exact bytes first, then what the cuts have.
struct AttributeRows {
  RawAccessor raw;
  Interpolation how = Interpolation::kLinear;
};

/// REQUIRES: `semantic` is not of a pair of JOINTS_n and WEIGHTS_n.
AttributeRows attribute_rows(const Document& document, const PrimitiveInstance& instance,
                             const RefinedPrimitive& refined, std::string_view semantic, std::size_t accessor,
                             bool morph_target);

/// The same for all pairs of JOINTS_n and WEIGHTS_n in `attributes`.
std::vector<SkinSet> skin_rows(const Document& document, const PrimitiveInstance& instance,
                               const RefinedPrimitive& refined, const Json& attributes);

/// Whether `semantic` belongs to one of the first `set_count` of those pairs.
bool is_of_skin(std::string_view semantic, std::size_t set_count);

/// Splits the refined mesh by instance. [instances.size()].
std::vector<RefinedPrimitive> split_by_instance(const radiosity::RefinedMesh& mesh, const ImportedScene& scene);

/// Rewrites `primitive` (a copy of the source primitive's JSON) for a changed instance: new indices and, for every
/// attribute but COLOR_0 (export_colors.h) and every morph target, a new accessor with the source vertices' exact bytes
/// first and the cuts' interpolated values after (interpolate_attributes.h). Appends accessors and bufferViews to
/// `document.json`; mode becomes TRIANGLES. `primitive` must not lie in `document`.
void export_geometry(Document& document, BufferBuilder& buffer, const PrimitiveInstance& instance,
                     const RefinedPrimitive& refined, Json& primitive);

}  // namespace gltf_radiosity
