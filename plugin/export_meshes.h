// The refined mesh -> glTF accessors, one set per primitive instance.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/refined_mesh.h"
#include "plugin/document.h"
#include "plugin/import_scene.h"

namespace gltf_radiosity {

/// One primitive instance of the refined mesh in its own numbering.
struct RefinedPrimitive {
  bool changed = false;                   ///< false: vertices and indices are the source's, only COLOR_0 is new
  std::vector<std::uint32_t> vertices;    ///< RefinedMesh vertex of each output vertex, [vertex_count]; the scene's own come first, in order
  std::vector<glm::uvec3> triangles;      ///< local indices, wound as glTF wants them in the node's space (turned back if mirrored)
};

/// Splits the refined mesh by instance. [instances.size()].
std::vector<RefinedPrimitive> split_by_instance(const radiosity::RefinedMesh& mesh, const ImportedScene& scene);

/// Where exporters put new data: one growing buffer that becomes the last one of the document.
class BufferBuilder {
 public:
  /// Appends, aligned to 4 bytes, and returns the offset.
  std::size_t append(std::span<const std::uint8_t> bytes);
  const Bytes& bytes() const { return bytes_; }

 private:
  Bytes bytes_;
};

/// Rewrites `primitive` (a copy of the source primitive's JSON) for a changed instance: new indices and, for every attribute
/// and morph target, a new accessor with the source vertices' exact bytes first and the midpoints' interpolated values after
/// (NORMAL and TANGENT renormalised, tangent sign kept; JOINTS and WEIGHTS merged, the strongest four kept; the rest linear).
/// Appends accessors and bufferViews to `document.json`; mode becomes TRIANGLES.
void export_geometry(Document& document, BufferBuilder& buffer, const PrimitiveInstance& instance, const RefinedPrimitive& refined,
                     const radiosity::RefinedMesh& mesh, Json& primitive);

}  // namespace gltf_radiosity
