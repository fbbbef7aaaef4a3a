// Triangle primitives -> KHR_draco_mesh_compression, colours, joints, weights and all else inside.
#pragma once

#include <vector>

#include "core/progress.h"
#include "plugin/append_accessor.h"
#include "plugin/document.h"

namespace gltf_radiosity {

/// Compresses every triangle primitive: it gets accessors of its own without data, and a blob at the end of `buffer`.
/// Floats are rounded to grids (attribute_grid.h), colours to `color_bits`; integers and custom attributes stay as they
/// are. Vertices are put into another order, and those that no triangle uses go, except where morph targets count on
/// the order; strips and fans become lists. What cannot be compressed is left alone, with a warning. The old accessors
/// stay. Parallel, with the same result for any number of threads; throws `Cancelled`.
///
/// REQUIRES: all data lies in document.buffers, and color_bits in [1, 24].
void compress_draco(Document& document, BufferBuilder& buffer, int color_bits, std::vector<Warning>& warnings,
                    const radiosity::Progress& progress);

}  // namespace gltf_radiosity
