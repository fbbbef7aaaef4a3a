// The node hierarchy -> where each node stands in the world.
#pragma once

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <optional>
#include <vector>

#include "plugin/document.h"

namespace gltf_radiosity {

/// A rotation of length 1; one without length or that is not finite turns nothing.
glm::dquat unit_rotation(const glm::dquat& rotation);

/// Index of the scene that is baked: the one asked for, the default one, or the first. None if the document has no
/// scenes; then every root is part of it. One that does not exist is ErrorCode::kBadOption.
Result<std::optional<std::size_t>> chosen_scene(const Json& root, std::optional<std::uint32_t> wanted);

struct PlacedNodes {
  std::vector<glm::dmat4> world_from_node;  ///< of every node of the document, [node_count]
  std::vector<std::int8_t> level;  ///< subdivision override, radiosity::kLevelFromPatchSize without one, [node_count]
  /// Nodes of the scene, parents before children, siblings in order; none that KHR_node_visibility hides.
  std::vector<std::uint32_t> visible;
};

/// Walks the scene that is baked (options.scene). Subdivision levels come from `extras.radiosity.subdivide` of the node
/// or its nearest ancestor that has it; one from options.subdivide (by name) wins over the node's own. A name that no
/// visible node has is ErrorCode::kBadOption. No recursion: hierarchies may be deep.
Result<PlacedNodes> place_nodes(const Document& document, const tinygltf::Model& model, const Options& options,
                                std::vector<Warning>& warnings);

}  // namespace gltf_radiosity
