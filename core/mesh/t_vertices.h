// T-vertices: cracks, where one surface has a vertex and its neighbour across an edge has none.
//
//        /\                     The long edge below is open: no other element has it. So are the two above it, and the
//       /  \  . . . .           vertex between those lies inside it. Light that is interpolated along both differs, and
//      /____\/_______\          rounding lets the background through.
//      \             / .
//       \___________/ .
//
// What merely touches is no crack: a box whose corner stands on an edge of the floor, with floor on both sides.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace radiosity {

struct TVertex {
  std::uint32_t vertex = 0;  ///< one of those at its position
  glm::uvec2 edge{0};        ///< the vertices that an element names as the ends of the edge
  float at = 0.0F;           ///< where on the edge, from x to y, (0,1)
};

/// All T-vertices of a mesh, each once for every position inside every open edge, in the order of the edges and along
/// them. A vertex within `tolerance` (metres) of an edge, and farther than that from its ends, lies inside it. Vertices
/// are joined where their positions are equal. Near linear in the number of open edges. Deterministic.
std::vector<TVertex> find_t_vertices(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                                     float tolerance);

/// What rounding may move a vertex off an edge, metres: a millionth of the extent, or of the distance from the origin.
float rounding_tolerance(std::span<const glm::vec3> positions);

}  // namespace radiosity
