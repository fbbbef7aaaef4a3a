// Light of elements -> light at vertices, by interpolation within smooth groups.
//
// Cohen and Greenberg. The Hemi-Cube: A Radiosity Solution for Complex Environments. 1985 (section 7)
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/refined_mesh.h"
#include "core/reconstruct/samples.h"
#include "core/reconstruct/smooth_groups.h"

namespace radiosity {

/// Irradiance at each vertex, [vertex_count], lx, never negative: the plane that fits the light of the elements around
/// it best. Buried elements do not count; where all are, light spreads from vertex to vertex.
std::vector<Rgb> interpolate_vertices(const RefinedMesh& mesh, const ElementLight& light);

}  // namespace radiosity
