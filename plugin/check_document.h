// Structural checks of a glTF's JSON tree, before anything trusts it.
#pragma once

#include "plugin/document.h"
#include "plugin/json_checker.h"

namespace gltf_radiosity {

/// Checks types and ranges of everything this project follows, in 64 bits, on the JSON alone: indices, accessors inside
/// bufferViews inside buffers, nodes that form a forest, required extensions. The error names the place.
Result<Done> check_structure(const Json& root);

/// The part of check_structure for buffers, bufferViews, accessors and meshes. REQUIRES: these are arrays of objects.
Result<Done> check_data(const Json& root);

/// The part of check_structure for EXT_lights_image_based. REQUIRES: scenes are objects.
Result<Done> check_environment(const Json& root);

/// Checks what needs the buffers' bytes: the indices of sparse accessors. REQUIRES: check_structure passed.
Result<Done> check_sparse_indices(const Document& document);

}  // namespace gltf_radiosity
