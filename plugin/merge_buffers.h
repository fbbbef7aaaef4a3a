// All data of a document in one buffer.
#pragma once

#include "plugin/append_accessor.h"
#include "plugin/document.h"

namespace gltf_radiosity {

/// Merges the buffers and `added`, which is buffer [document.buffers.size()], into one, and points the bufferViews to
/// it. The tree's first buffer has no uri afterwards, the name and extras of the first, and in its extras those of the
/// others; the only other one is the empty one that decoders of EXT_meshopt_compression fill, if there is any use for
/// it. A document without data has no buffers. Empties document.buffers.
Bytes merge_buffers(Document& document, const BufferBuilder& added);

/// Moves the images that lie in files of their own to the end of `merged`, bytes untouched.
Result<Done> embed_images(Document& document, Bytes& merged);

/// "image/png" and so on, by content; "application/octet-stream" if it is nothing that glTF knows.
const char* image_type(std::span<const std::uint8_t> bytes);

/// Whether images[i] is a file of its own.
bool is_external(const Json& image);

}  // namespace gltf_radiosity
