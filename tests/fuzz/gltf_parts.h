// A glTF's tree and its binary chunk, taken apart and put together again with lengths that agree.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

namespace gltf_radiosity::fuzz {

using Json = nlohmann::ordered_json;
using Bytes = std::vector<std::uint8_t>;

struct GltfParts {
  Json json;
  Bytes binary;         ///< empty for a .gltf
  bool is_glb = false;  ///< otherwise text alone
};

/// None if the text is no JSON object, or is nested deeper than any glTF.
std::optional<GltfParts> take_apart(std::span<const std::uint8_t> bytes);

/// The lengths of chunks and file are right, and so is that of the first buffer of a GLB.
Bytes put_together(GltfParts parts);

}  // namespace gltf_radiosity::fuzz
