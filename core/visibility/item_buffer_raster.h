// The item buffer by clipping and scan conversion: each triangle is clipped to the five faces of the hemicube,
// projected, and kept in the cells whose centres it covers if it is nearer than what is there.
//
// Cohen and Greenberg. The Hemi-Cube: A Radiosity Solution for Complex Environments. 1985
// Sutherland and Hodgman. Reentrant Polygon Clipping. 1974
//
// Needs no acceleration structure: linear in the number of triangles, so the better maker only in small scenes
// (docs/benchmarks.md says where it stops paying). It shares nothing with Embree, which makes it the check on it.
#pragma once

#include <cstddef>
#include <memory>

#include "core/visibility/item_buffer.h"

namespace radiosity {

/// `scene` must outlive the maker.
std::unique_ptr<ItemBufferMaker> make_item_buffer_raster(const Scene& scene);

/// Whether this maker beats item_buffer_rays.h in a scene of so many triangles with hemicubes `resolution` cells wide:
/// its cost is in the triangles, that of rays in the cells (measured: docs/benchmarks.md).
bool raster_is_faster(std::size_t triangle_count, int resolution = 32);

}  // namespace radiosity
