// The node hierarchy -> where each node stands in the world.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <vector>

#include "plugin/document.h"

namespace gltf_radiosity {

struct PlacedNodes {
  std::vector<glm::dmat4> world_from_node;  ///< of every node of the document, [node_count]
  std::vector<std::int8_t> level;  ///< subdivision override, radiosity::kLevelFromPatchSize without one, [node_count]
  std::vector<std::uint32_t> visible;  ///< nodes of the scene, parents before children, siblings in order
};

/// Walks the default scene; the first one if none is the default; every root if there are no scenes. Subdivision levels
/// come from `extras.radiosity.subdivide` of the node or its nearest ancestor that has it; one from `subdivide` (by
/// name) wins over the node's own. A name that no visible node has is ErrorCode::kBadOption. No recursion: hierarchies
/// may be deep.
Result<PlacedNodes> place_nodes(const Document& document, const tinygltf::Model& model,
                                const std::vector<std::pair<std::string, int>>& subdivide,
                                std::vector<Warning>& warnings);

}  // namespace gltf_radiosity
