// EXT_meshopt_compression and KHR_meshopt_compression -> plain bufferViews.
#pragma once

#include "plugin/document.h"

namespace gltf_radiosity {

inline constexpr const char* kMeshoptExtension = "EXT_meshopt_compression";

/// Whether a buffer holds nothing but what its compressed bufferViews decode to: it need not be read, and often there
/// is nothing to read.
bool is_placeholder(const Json& buffer);

/// Decodes every bufferView that is compressed by meshoptimizer: the data goes into a new buffer at the end, and the
/// extension leaves the tree. Compressed bytes, placeholders and fallback buffers that nothing refers to any more are
/// dropped. Sizes are checked before memory is asked for. REQUIRES: check_structure passed; placeholders are empty.
/// Errors name the bufferView.
Result<Done> decode_meshopt(Document& document);

}  // namespace gltf_radiosity
