// Light of elements -> light at vertices, by interpolation within smooth groups.
//
// Cohen and Greenberg. The Hemi-Cube: A Radiosity Solution for Complex Environments. 1985 (section 7)
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/refined_mesh.h"
#include "core/reconstruct/gather.h"

namespace radiosity {

/// Vertices at one position whose shading normals agree take one value: a texture seam or a change of material shows no
/// step, a crease keeps two sides apart.
struct SmoothGroups {
  std::vector<std::uint32_t> group_of_vertex;  ///< [vertex_count], numbered by first appearance
  std::uint32_t group_count = 0;
};

/// Normals agree if they are less than 15 degrees apart; a vertex without one counts with the mean of its elements'.
SmoothGroups find_smooth_groups(const RefinedMesh& mesh);

/// Irradiance at each vertex, [vertex_count], lx, never negative: the plane that fits the light of the elements around
/// it best. Buried elements do not count; where all are, light spreads from vertex to vertex.
std::vector<Rgb> interpolate_vertices(const RefinedMesh& mesh, const ElementLight& light);

}  // namespace radiosity
