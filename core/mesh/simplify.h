// Takes out vertices that neither the shape nor anything the vertices carry needs.
//
// A vertex moves onto a neighbour, the two elements at the edge between them go, and all other vertices stay exactly as
// they are (a half-edge collapse). Whether it may is decided by every vertex removed so far and the middles of the
// edges that vanish: there, what elements show must not differ from what the mesh showed before by more than is
// allowed. Small differences come first: all vertices that cost a sixteenth of what is allowed, then an eighth, and so
// on.
//
// Lines stay: borders, and edges whose sides name different vertices (seams, creases, changes of material). A vertex on
// one leaves only if the line runs straight through it, and then on both sides at once. Where lines meet or end it
// stays.
//
// Hoppe. Progressive Meshes. 1996
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/carried.h"
#include "core/mesh/refined_mesh.h"
#include "core/progress.h"

namespace radiosity {

/// What is left of a mesh.
struct Simplified {
  std::vector<std::uint32_t> elements;  ///< those that stay, ascending
  std::vector<glm::uvec3> corners;      ///< of each, vertices of the mesh; equal vertices (carried.h) are one
  double squared_light_change = 0.0;    ///< of luminance, summed over the surface: times m2
};

/// Elements that OpenMesh does not take (openmesh_join.h), and those without area, stay as they are. No element turns
/// by more than 45 degrees or becomes a needle. Parallel; deterministic; throws `Cancelled`.
Simplified simplify(const RefinedMesh& mesh, const Carried& carried, const Progress& progress);

}  // namespace radiosity
