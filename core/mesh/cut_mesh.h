// The display mesh while its edges are being halved.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <unordered_set>
#include <vector>

#include "core/mesh/openmesh_bridge.h"
#include "core/mesh/refined_mesh.h"
#include "core/mesh/weld.h"
#include "core/scene.h"

namespace radiosity {

/// One number for an unordered pair.
std::uint64_t pair_key(const glm::uvec2& pair);

/// Starts as the scene's own triangles. Vertices of `mesh` are always up to date, its elements after write_elements().
struct CutMesh {
  explicit CutMesh(const Scene& scene);

  /// Squared distance of two position classes, m2: the same from either end.
  double squared_length(const glm::uvec2& end_classes) const;
  /// False for edges without length, and for those so short that their middle rounds to an end.
  bool can_be_halved(const glm::uvec2& end_classes) const;

  /// A new vertex halfway between two of one glTF primitive.
  std::uint32_t add_midpoint(const glm::uvec2& ends);
  /// The class of the place `at` of the way between two.
  std::uint32_t class_between(const glm::uvec2& end_classes, float at);
  /// A new vertex there, between two that lie at these ends in either order.
  std::uint32_t add_between(const glm::uvec2& ends, const glm::uvec2& end_classes, float at,
                            std::uint32_t position_class);
  /// A new vertex anywhere between them, at the position of a class.
  std::uint32_t add_cut(const Cut& cut, std::uint32_t position_class);
  /// Halves an edge; side i names the midpoint `midpoint_of_side[i]`, made by add_midpoint(). Returns the elements that
  /// are new on each side, see OpenMeshBridge::cut().
  std::array<std::uint32_t, 2> halve(std::uint32_t edge, const std::array<std::uint32_t, 2>& midpoint_of_side);
  void write_elements() { bridge.write_elements(mesh); }

  /// Makes a vertex one side of a seam of light by itself (RefinedMesh::side_of_seam).
  void set_apart(std::uint32_t vertex) { set_side(vertex, ++side_count); }
  /// Makes it the side `side` of one.
  void set_side(std::uint32_t vertex, std::uint32_t side);
  /// Where an edge is cut: whether it is a seam; its parts are seams then.
  bool split_seam(const glm::uvec2& end_classes, std::uint32_t middle_class);

  Welder welder;                               ///< where each position class is; grows with the midpoints
  std::vector<std::uint32_t> class_of_vertex;  ///< of the scene's own
  OpenMeshBridge bridge;
  RefinedMesh mesh;
  std::unordered_set<std::uint64_t> seams;  ///< pair_key() of the edges that light jumps at (cut_contacts.h)
  std::uint32_t side_count = 0;             ///< sides of seams so far
};

}  // namespace radiosity
