// Triangle primitives -> EXT_meshopt_compression.
#pragma once

#include <vector>

#include "core/progress.h"
#include "plugin/append_accessor.h"
#include "plugin/document.h"

namespace gltf_radiosity {

/// Compresses every triangle primitive, morph targets too: it gets accessors of its own whose bufferViews are
/// compressed, at the end of `buffer`. Floats are rounded to grids (attribute_grid.h); integers and custom attributes
/// stay as they are. Vertices are put into another order, and those that no triangle uses go; strips and fans become
/// lists. What primitives share they share afterwards. What cannot be compressed is left alone, with a warning. The old
/// accessors stay. Parallel, with the same result for any number of threads; throws `Cancelled`.
///
/// REQUIRES: all data lies in document.buffers.
void compress_meshopt(Document& document, BufferBuilder& buffer, std::vector<Warning>& warnings,
                      const radiosity::Progress& progress);

}  // namespace gltf_radiosity
