// The JSON tree of a glTF and its buffers: the source of truth, so that nothing is lost.
//
// tinygltf loses and rewrites parts of a file and trusts what it reads (docs/decisions). So the tree is parsed with
// nlohmann::ordered_json, checked here before anything trusts it, and patched to write. tinygltf gets a sanitised copy
// and serves as the typed view of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "plugin/gltf_radiosity.h"
#include "plugin/input_folder.h"
#include "plugin/memory_budget.h"
#include "plugin/result.h"

namespace tinygltf {  // renamed to gr_tinygltf by a compile definition (cmake/dependencies.cmake)
class Model;
}

namespace gltf_radiosity {

using Json = nlohmann::ordered_json;
using Bytes = std::vector<std::uint8_t>;

/// Shapes: buffers is [json["buffers"].size()], each at least as long as its byteLength says. Images stay where they
/// are (a bufferView, a data URI, or a file in `folder`).
///
/// Invariant after read_document: every index that this project follows (accessor, bufferView, buffer, mesh, node,
/// material, texture, image, sampler, light) is in range, every accessor and bufferView lies inside its buffer (in 64
/// bits), the node hierarchy is a forest, and what Draco or meshoptimizer compressed has been decoded: there are plain
/// accessors and bufferViews, and KHR_draco_mesh_compression and EXT_meshopt_compression have left the tree.
struct Document {
  Json json;
  std::vector<Bytes> buffers;
  InputFolder folder;
  std::vector<Warning> warnings;
  std::shared_ptr<MemoryBudget> memory = std::make_shared<MemoryBudget>();  ///< what its data and its scene may take
};

/// How a document is read.
struct ReadOptions {
  bool allow_outside = false;            ///< the files it names may lie outside its folder
  std::vector<std::string> spared_by{};  ///< files that will be written: an error if the document needs one of them
  std::uint64_t max_memory = kAnySize;   ///< bytes
};

/// Reads a .glb or .gltf (told apart by content). External buffers are read; the paths of buffers and images must stay
/// in the file's folder or below, unless allowed otherwise. Errors name the place, `accessors[3]`.
Result<Document> read_document(const std::filesystem::path& file, const ReadOptions& options = {});
Result<Document> read_document(std::span<const std::uint8_t> bytes, const InputFolder& folder,
                               const ReadOptions& options = {});

/// The document as tinygltf types: materials, textures, samplers, nodes, meshes, accessors, lights. Buffers and images
/// are left empty in it: read data with accessor_view.h and image_decode.h. Indices agree with the JSON tree.
Result<std::shared_ptr<const tinygltf::Model>> typed_view(const Document& document);

/// The bytes behind a URI: a data URI decoded, or a file as input_folder.h has it. `place` goes into errors.
Result<Bytes> read_uri(const std::string& uri, const InputFolder& folder, const std::string& place);

/// The encoded bytes (PNG, JPEG, ...) of images[`image`].
Result<Bytes> image_bytes(const Document& document, std::size_t image);

/// "meshes[3].primitives[0]" from parts, for error places.
std::string place_of(std::string_view array, std::size_t index);
std::string place_of_primitive(std::size_t mesh, std::size_t primitive);

}  // namespace gltf_radiosity
