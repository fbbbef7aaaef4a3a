// KHR_draco_mesh_compression -> plain accessors.
#pragma once

#include "plugin/document.h"

namespace gltf_radiosity {

/// Decodes every primitive that is compressed with Draco: its data goes into new buffers and bufferViews at the end,
/// its accessors get a bufferView (a clone of the accessor if another primitive needs it too), and the extension leaves
/// the tree. REQUIRES: check_structure passed. Errors name the primitive.
Result<Done> decode_draco(Document& document);

}  // namespace gltf_radiosity
