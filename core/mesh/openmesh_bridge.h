// Triangles <-> OpenMesh, to cut edges.
//
// Triangles are joined where they share an edge by position, whatever glTF vertices they name there, and edges are
// halved by OpenMesh. What a glTF vertex adds to a position is kept per corner, outside OpenMesh's vertices, so a seam
// is an ordinary edge whose two sides name different vertices.
//
// OpenMesh takes two triangles at an edge, of like orientation, and nothing else. A triangle it refuses (the third at
// an edge, a neighbour wound the other way, a duplicate, one that names a position twice) is entered on vertices of its
// own. Its edges are then copies: edges of equal ends that OpenMesh does not know to be one. Who halves one halves all.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>

#include "core/mesh/refined_mesh.h"
#include "core/scene.h"

namespace radiosity {

/// Triangles as an OpenMesh mesh. Edges keep their numbers; new ones are added behind.
class OpenMeshBridge {
 public:
  /// `class_of_vertex` [vertex_count] says which vertices share a position, `position_of_class` where.
  OpenMeshBridge(std::span<const glm::uvec3> triangles, std::span<const std::uint32_t> class_of_vertex,
                 std::span<const glm::vec3> position_of_class);
  ~OpenMeshBridge();
  OpenMeshBridge(const OpenMeshBridge&) = delete;
  OpenMeshBridge& operator=(const OpenMeshBridge&) = delete;

  std::uint32_t edge_count() const;
  std::uint32_t face_count() const;

  /// The position classes of the ends, the smaller first: copies of an edge, and only they, agree in it.
  glm::uvec2 end_classes(std::uint32_t edge) const;
  /// False if `edge` certainly has no copies.
  bool may_have_copies(std::uint32_t edge) const;
  /// The scene triangle on a side (0 or 1) of `edge`; kNothing beyond a boundary, which is on one side at most.
  std::uint32_t triangle_at(std::uint32_t edge, unsigned int side) const;
  /// The element on a side of `edge`, in [0, face_count()); kNothing beyond a boundary. Elements keep their numbers.
  std::uint32_t element_at(std::uint32_t edge, unsigned int side) const;
  /// The edges of an element.
  std::array<std::uint32_t, 3> edges_of(std::uint32_t element) const;
  /// The scene triangle that an element is part of.
  std::uint32_t triangle_of(std::uint32_t element) const;
  /// How the triangle on a side names the ends of `edge`: vertices of the refined mesh, as the triangle is wound.
  /// REQUIRES: there is one.
  glm::uvec2 vertices_at(std::uint32_t edge, unsigned int side) const;

  /// The position classes of the corners opposite `edge`, by side. REQUIRES: there is an element on either side.
  glm::uvec2 opposite_classes(std::uint32_t edge) const;
  /// Lets `edge` join those instead; the elements beside it keep their numbers, and so does it. False, and nothing
  /// done, if an edge does already. REQUIRES: the same triangle on either side, and that they make a convex quad.
  bool turn(std::uint32_t edge);

  /// Lets an element name `vertex` where it named `old_vertex` so far.
  void rename(std::uint32_t element, std::uint32_t old_vertex, std::uint32_t vertex);

  /// Opens a round in which `edges` edges, `sides` triangles at them counted, will be halved: those that exist now.
  void begin_round(std::size_t edges, std::size_t sides);
  /// Cuts an edge in two: at `position`, which is that of class `position_class`, `at` (0,1) of the way from the first
  /// of its end_classes() to the second. Side i names the new vertex `vertex_of_side[i]`. The edge keeps its number for
  /// one of the parts; the element on each side keeps its number for one of its parts; returns the number of the other
  /// part on each side, kNothing where there is no element.
  std::array<std::uint32_t, 2> cut(std::uint32_t edge, float at, std::uint32_t position_class,
                                   const glm::vec3& position, const std::array<std::uint32_t, 2>& vertex_of_side);
  /// Turns edges inside the triangles of this round so that the cut is the one drawn in subdivide_uniform.h.
  void end_round();

  /// Fills in the elements, in the order of their numbers. An uncut triangle's corners keep their order.
  void write_elements(RefinedMesh& mesh) const;

 private:
  struct Net;
  std::unique_ptr<Net> net_;
};

}  // namespace radiosity
