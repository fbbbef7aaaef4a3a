// Edges between the same two places, found and cut together: across seams, primitives and nodes.
//
// The copies of an edge (openmesh_bridge.h) are one line to the eye, so who cuts one cuts all. Each pair of vertices
// that ends a copy gets one new vertex between them; along a seam of light (CutMesh::seams) each side gets its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/mesh/cut_mesh.h"

namespace radiosity {

/// What a mesh may grow to.
struct MeshLimits {
  std::size_t max_vertices = std::numeric_limits<std::size_t>::max();
  std::size_t max_elements = std::numeric_limits<std::size_t>::max();
};

/// Keeps track of the edges of a mesh that is being cut. Not thread-safe; deterministic.
class EdgeCopies {
 public:
  /// `cut` must outlive it, and its edges may only be cut here from here on.
  explicit EdgeCopies(CutMesh& cut);

  /// An edge and all that lie between the same two places.
  std::vector<std::uint32_t> copies_of(std::uint32_t edge) const;

  /// Whether the mesh stays within limits if all these are cut.
  bool fits(std::span<const std::uint32_t> copies, const MeshLimits& limits) const;

  /// An element that lost a part, which became one of its own.
  struct Part {
    std::uint32_t of_element = 0, element = 0;
  };
  /// Halves an edge and all its copies.
  std::vector<Part> halve(std::span<const std::uint32_t> copies);
  /// Cuts them `at` (0,1) of the way from the first of their end classes to the second.
  std::vector<Part> cut(std::span<const std::uint32_t> copies, float at);

  /// Lets an edge inside a triangle join the corners opposite it (OpenMeshBridge::turn()). False, and nothing done, if
  /// it has copies, or an edge lies there already.
  bool turn(std::uint32_t edge);

 private:
  void remember(std::uint32_t edge);

  CutMesh& cut_;
  std::unordered_map<std::uint64_t, std::uint32_t> first_edge_between_;  ///< two position classes
  std::vector<std::uint32_t> next_copy_;                                 ///< [edge_count], kNothing ends a list
};

}  // namespace radiosity
