// Triangles <-> OpenMesh, to take vertices out.
//
// Triangles are joined where they share an edge by position, whatever glTF vertices they name there. Who calls keeps
// what the glTF vertices add. Where OpenMesh refuses a triangle (openmesh_join.h) or several fans meet in a point, the
// vertices are fixed: what it does not see beside them must not be torn off.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

namespace radiosity {

/// Vertices are position classes (weld.h), elements and edges have numbers of their own; all numbers stay.
class CollapseNet {
 public:
  /// `class_of_vertex` [vertex_count] says which vertices share a position, `class_count` how many there are.
  CollapseNet(std::span<const glm::uvec3> elements, std::span<const std::uint32_t> class_of_vertex,
              std::uint32_t class_count);
  ~CollapseNet();
  CollapseNet(const CollapseNet&) = delete;
  CollapseNet& operator=(const CollapseNet&) = delete;

  std::uint32_t edge_count() const;
  bool is_fixed(std::uint32_t vertex) const;

  /// An edge that leads away from a vertex, and the element on its left: kNothing beyond a border.
  struct Spoke {
    std::uint32_t to = 0, edge = 0, element = 0;
  };
  /// Those of a vertex, clockwise, replacing what is in `spokes`.
  void find_spokes(std::uint32_t vertex, std::vector<Spoke>& spokes) const;
  /// The edge from one vertex to another. REQUIRES: there is one.
  std::uint32_t edge_between(std::uint32_t from, std::uint32_t to) const;

  /// Moves a vertex onto a neighbour; the elements at the edge between them go. Answers false, and does nothing, where
  /// that would change what the surface is joined to. Not for several threads.
  bool collapse(std::uint32_t from, std::uint32_t to);

 private:
  struct Net;
  std::unique_ptr<Net> net_;
};

}  // namespace radiosity
