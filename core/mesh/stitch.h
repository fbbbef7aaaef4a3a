// Closes the cracks that a scene comes with: an edge is cut where a vertex of its neighbour lies on it.
#pragma once

#include <cstddef>

#include "core/mesh/cut_mesh.h"

namespace radiosity {

/// Cuts every open edge of an uncut mesh at the T-vertices inside it (t_vertices.h), so that both sides are cut alike
/// from then on. A cut takes the position of the T-vertex, so that their light is one. Returns how many cuts were made;
/// where more than `max_cuts` were needed, none.
std::size_t stitch(CutMesh& cut, std::size_t max_cuts);

}  // namespace radiosity
