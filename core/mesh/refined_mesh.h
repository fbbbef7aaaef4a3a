// The display mesh: the scene's triangles cut into elements, and where every new vertex came from.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "core/scene.h"

namespace radiosity {

/// A vertex that cuts the line between two others: (1 - at) of the one and `at` of the other. Between a vertex and
/// itself lies a copy of it.
struct Cut {
  glm::uvec2 ends{0};
  float at = 0.5F;  ///< (0,1)

  bool operator==(const Cut&) const = default;
};

/// Shapes: per vertex [vertex_count], per element [element_count]. The scene's vertices come first, unchanged and in
/// order; vertex `scene_vertex_count + k` lies between the two earlier vertices that `cuts[k]` names.
///
/// Every attribute of a glTF vertex can be carried over by walking `cuts` once from front to back. The two ends of a
/// cut always belong to the same glTF primitive, so a seam stays a seam.
struct RefinedMesh {
  std::uint32_t scene_vertex_count = 0;
  std::vector<Cut> cuts;             ///< [vertex_count - scene_vertex_count]
  std::vector<glm::vec3> positions;  ///< metres
  std::vector<glm::vec3> normals;    ///< unit, or zero where the scene's are
  /// Where light jumps (cut_contacts.h) vertices at one place show one light only if their sides are equal; 0
  /// elsewhere. May end early: vertices behind its end have 0.
  std::vector<std::uint32_t> side_of_seam{};
  std::vector<glm::uvec3> elements;  ///< vertex indices, wound like their triangle; grouped by ascending triangle
  std::vector<std::uint32_t> triangle_of_element;  ///< the scene triangle an element is part of
  std::vector<SubTriangle> part_of_element;        ///< which part
};

/// The mesh of an unrefined scene: one element per triangle, in order.
RefinedMesh unrefined(const Scene& scene);

/// Appends to values at the first vertices, in order, those at the vertices behind them.
void append_cuts(const RefinedMesh& mesh, std::vector<Rgb>& values);

/// Sorts elements by ascending triangle, as RefinedMesh wants them; those of one triangle keep their order.
void group_by_triangle(RefinedMesh& mesh, std::size_t triangle_count);

/// The side of a seam of light that a vertex is on, 0 if on none.
inline std::uint32_t side_of(const RefinedMesh& mesh, std::uint32_t vertex) {
  return vertex < mesh.side_of_seam.size() ? mesh.side_of_seam[vertex] : 0;
}

/// Area of an element, m2.
float element_area(const RefinedMesh& mesh, std::uint32_t element);

}  // namespace radiosity
