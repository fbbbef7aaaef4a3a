// --select, --exclude and extras.radiosity.ignore: which nodes receive light. The others still cast shadows and send
// it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "plugin/document.h"

namespace gltf_radiosity {

/// Which nodes receive light: [node_count], 0 or 1. A node does as its parent does, unless its own
/// extras.radiosity.ignore says otherwise; options.select and options.exclude, patterns of names, say otherwise again,
/// exclude last. What has no parent receives if nothing is selected by name. `visible`: the nodes of the scene, parents
/// before children. A pattern that fits no visible node is ErrorCode::kBadOption.
Result<std::vector<std::uint8_t>> receiving_nodes(const Document& document, std::span<const std::uint32_t> visible,
                                                  const Options& options, std::vector<Warning>& warnings);

}  // namespace gltf_radiosity
