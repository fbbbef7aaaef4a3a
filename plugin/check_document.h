// Structural checks of a glTF's JSON tree, before anything trusts it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "plugin/document.h"

namespace gltf_radiosity {

/// Checks types and ranges of everything this project follows, in 64 bits, on the JSON alone: indices, accessors inside
/// bufferViews inside buffers, nodes that form a forest, required extensions. The error names the place.
Result<Done> check_structure(const Json& root);

/// Checks what needs the buffers' bytes: the indices of sparse accessors. REQUIRES: check_structure passed.
Result<Done> check_sparse_indices(const Document& document);

/// A whole number that is not negative: 3 and 3.0 are the same in JSON. None if it is anything else.
std::optional<std::uint64_t> whole_number(const Json& value);

/// `root[key]`, or an empty array if it is missing.
const Json& array_of(const Json& root, const std::string& key);

/// `object.extensions[name]`, or null if it has no such extension.
const Json* extension_of(const Json& object, const char* name);

}  // namespace gltf_radiosity
