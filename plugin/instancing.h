// EXT_mesh_gpu_instancing: one node that shows its mesh many times.
//
// The copies stand in different light and each needs a COLOR_0 of its own, which instancing cannot give them: what has
// been baked becomes nodes. Instances that are not baked stay as they are.
#pragma once

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

#include "plugin/document.h"
#include "plugin/import_scene.h"

namespace gltf_radiosity {

/// The extension of nodes[`node`], or null.
const Json* instancing_of(const Document& document, std::size_t node);

/// Where the copies of the node's mesh stand in the node's space; without the extension there is one, in its place.
std::vector<glm::dmat4> copy_transforms(const Document& document, std::size_t node);

/// Gives every copy of an instanced node with an instance that receives light a node of its own, a child of that node:
/// named after it, with its mesh, its morph weights (their animation too), and what custom attributes say of it in its
/// extras. Returns the node of each instance, [instances.size()].
std::vector<std::size_t> expand_copies(Document& document, std::span<const PrimitiveInstance> instances);

}  // namespace gltf_radiosity
