// More morph targets for a mesh: its names, the weights of its nodes and their animations follow.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "plugin/append_accessor.h"
#include "plugin/document.h"

namespace gltf_radiosity {

/// Targets that were put behind the `old_count` that a mesh had; their weights are 1.
struct AddedTargets {
  std::size_t old_count = 0;
  std::vector<std::string> names;
};

/// Appends names to the mesh's extras.targetNames, ones to its weights and to those of the nodes that show it, and to
/// every key of the animations of these weights. Nobody has checked the animations: one that makes no sense is left as
/// it is, with a warning.
void add_morph_weights(Document& document, BufferBuilder& buffer, std::size_t mesh, const AddedTargets& added,
                       std::vector<Warning>& warnings);

}  // namespace gltf_radiosity
