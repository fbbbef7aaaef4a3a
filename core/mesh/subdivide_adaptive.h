// Bisects chosen elements at their longest edge, and their neighbours as far as it takes to leave no T-vertex.
//
// An edge is halved only when it is the longest one of every element at it; elements that have a longer one are
// bisected there first. So shapes stay as good as the scene's triangles allow, however often they are cut. All copies
// of an edge (openmesh_bridge.h) are halved together: across seams, primitives and nodes.
//
//          /|\                    /|\                                                                                  .
//         / | \                  /_|_\      The right element has a longer edge than the one it shares with the left, .
//        /  |   \       ->      /  | /  \   so it is bisected there first. .
//       /___|_____\            /___|/_____\                                                                            .
//
// Rivara. New Longest-Edge Algorithms for the Refinement and/or Improvement of Unstructured Triangulations. 1997
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/cut_contacts.h"
#include "core/mesh/cut_mesh.h"
#include "core/mesh/edge_copies.h"
#include "core/scene.h"

namespace radiosity {

struct BisectLimits {
  MeshLimits mesh;
  float min_edge = 0.0F;  ///< elements whose longest edge is not longer than this are not bisected, metres
  /// Triangles with a level of their own, [triangle_count] or empty: their elements are not bisected, as in
  /// SubdivideOptions.
  std::span<const std::int8_t> level_of_triangle;
};

/// Keeps track of the copies of edges, so that rounds cost what they cut. Not thread-safe; deterministic.
class Bisector {
 public:
  /// `edges` are those of `cut`, and `contacts`, if any, cuts both; all must outlive it.
  Bisector(CutMesh& cut, EdgeCopies& edges, const BisectLimits& limits, ContactCutter* contacts = nullptr);

  /// Length of an element's longest edge, metres.
  double longest_edge(std::uint32_t element) const;
  /// Whether an element is larger than the floor and of a triangle without a level of its own.
  bool can_be_bisected(std::uint32_t element) const;

  /// Bisects those of `elements` that can be, in this order, each once at least, or cuts them along the contacts that
  /// cross them; stops before what exceeds a limit.
  /// Returns which of the elements before each element after was part of, [element_count].
  std::vector<std::uint32_t> bisect(std::span<const std::uint32_t> elements);
  /// Bisects until no element has a longer edge, or a limit is reached; not along contacts.
  void bisect_longer_than(double length);

  /// Whether something was left uncut because of `max_vertices` or `max_elements`.
  bool reached_limit() const { return reached_limit_; }
  std::size_t max_vertices() const { return limits_.mesh.max_vertices; }

 private:
  std::uint32_t longest_edge_of(std::uint32_t element) const;
  bool is_longer(std::uint32_t edge, std::uint32_t than) const;
  std::uint32_t edge_to_halve_before(std::uint32_t edge) const;
  void begin_round();
  void note(std::span<const EdgeCopies::Part> parts);
  void bisect_at(std::uint32_t edge);

  CutMesh& cut_;
  EdgeCopies& edges_;
  BisectLimits limits_;
  ContactCutter* contacts_;
  bool reached_limit_ = false;
  std::vector<std::uint32_t> origin_;  ///< this round, [element_count]
  std::vector<std::uint8_t> is_cut_;   ///< this round, [element_count] when it began
};

}  // namespace radiosity
