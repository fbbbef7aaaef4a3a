// The refined mesh -> glTF accessors, one set per primitive instance.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/refined_mesh.h"
#include "plugin/append_accessor.h"
#include "plugin/document.h"
#include "plugin/import_scene.h"

namespace gltf_radiosity {

/// One primitive instance of the refined mesh in its own numbering.
struct RefinedPrimitive {
  bool changed = false;  ///< false: vertices and indices are the source's, only COLOR_0 is new
  std::vector<std::uint32_t>
      vertices;                      ///< RefinedMesh vertex of each output vertex; the scene's own come first, in order
  std::vector<radiosity::Cut> cuts;  ///< where each of the others is, between output vertices before it
  std::vector<glm::uvec3> triangles;    ///< output vertices, wound as glTF wants them in the node's space
  std::vector<std::uint32_t> elements;  ///< RefinedMesh element of each triangle

  std::size_t source_vertex_count() const { return vertices.size() - cuts.size(); }
};

/// Splits the refined mesh by instance. [instances.size()].
std::vector<RefinedPrimitive> split_by_instance(const radiosity::RefinedMesh& mesh, const ImportedScene& scene);

/// Rewrites `primitive` (a copy of the source primitive's JSON) for a changed instance: new indices and, for every
/// attribute but COLOR_0 (export_colors.h) and every morph target, a new accessor with the source vertices' exact bytes
/// first and the cuts' interpolated values after (interpolate_attributes.h). Appends accessors and bufferViews to
/// `document.json`; mode becomes TRIANGLES. `primitive` must not lie in `document`.
void export_geometry(Document& document, BufferBuilder& buffer, const PrimitiveInstance& instance,
                     const RefinedPrimitive& refined, Json& primitive);

}  // namespace gltf_radiosity
