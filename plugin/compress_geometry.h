// Small files: compression as a stage of its own, after the export.
#pragma once

#include <vector>

#include "core/progress.h"
#include "plugin/append_accessor.h"
#include "plugin/document.h"

namespace gltf_radiosity {

/// Compresses the triangles of the whole document as `options` ask for, and drops the data that is not needed any more;
/// does nothing unless they ask. `added` is the last buffer, [document.buffers.size()], before and after. Throws
/// `Cancelled`.
void compress_geometry(Document& document, BufferBuilder& added, const Options& options, std::vector<Warning>& warnings,
                       const radiosity::Progress& progress);

}  // namespace gltf_radiosity
