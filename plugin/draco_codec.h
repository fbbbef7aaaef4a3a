// KHR_draco_mesh_compression -> plain accessors.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "plugin/accessor_view.h"
#include "plugin/document.h"

namespace draco {
class Mesh;
class PointAttribute;
}  // namespace draco

namespace gltf_radiosity {

inline constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

/// Decodes every primitive that is compressed with Draco: its data goes into new buffers and bufferViews at the end,
/// its accessors get a bufferView (a clone of the accessor if another primitive needs it too), and the extension leaves
/// the tree. REQUIRES: check_structure passed. Errors name the primitive.
Result<Done> decode_draco(Document& document);

/// The mesh in one blob; `place` goes into errors.
Result<std::unique_ptr<draco::Mesh>> decode_draco_blob(std::span<const std::uint8_t> blob, const std::string& place);

/// The same for a blob that anyone may have made. Draco takes some numbers that it finds in one for the length of a
/// loop or of an array, and does not compare them with anything; so it reads the blob in a process of its own first
/// (child_trial.h), which may take a second of CPU time, and one more for every 64 KiB.
Result<std::unique_ptr<draco::Mesh>> decode_foreign_draco_blob(std::span<const std::uint8_t> blob,
                                                               const std::string& place);

/// The values of an attribute at every point of `mesh`, converted to `component`, one row every `stride` bytes of
/// `bytes`, [num_points * stride]. False if they cannot be converted.
bool copy_draco_values(const draco::Mesh& mesh, const draco::PointAttribute& attribute, ComponentType component,
                       std::size_t stride, Bytes& bytes);

}  // namespace gltf_radiosity
