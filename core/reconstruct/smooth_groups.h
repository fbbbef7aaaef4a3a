// Which vertices show one light: those at one position whose shading normals agree.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/refined_mesh.h"

namespace radiosity {

/// Vertices at one position whose shading normals agree take one value: a texture seam or a change of material shows no
/// step, a crease keeps two sides apart, and so does a line where light jumps (RefinedMesh::side_of_seam).
struct SmoothGroups {
  std::vector<std::uint32_t> group_of_vertex;  ///< [vertex_count], numbered by first appearance
  std::uint32_t group_count = 0;
};

/// Normals agree if they are less than 15 degrees apart; a vertex without one counts with the mean of its elements'.
SmoothGroups find_smooth_groups(const RefinedMesh& mesh);

/// Lets light spread along elements from groups where it is known to those where it is not, a ring at a time. `known`
/// and `value` are [group_count]; what no element joins to a known group keeps its value.
void spread_to_unknown(const RefinedMesh& mesh, const SmoothGroups& groups, std::vector<std::uint8_t>& known,
                       std::vector<Rgb>& value);

}  // namespace radiosity
