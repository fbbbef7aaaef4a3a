// A patched document -> bytes -> files that appear whole or not at all.
#pragma once

#include <filesystem>

#include "plugin/document.h"
#include "plugin/export_meshes.h"

namespace gltf_radiosity {

/// The document as one GLB: all buffers merged into the binary chunk, external images embedded, bytes untouched.
Result<Bytes> to_glb(Document document, const BufferBuilder& added);

/// Writes .glb, .embedded.gltf (everything as data URIs) or .gltf + .bin (images that lie outside the output's folder are
/// copied beside it), by the output's name. Each file is written beside its target, flushed and renamed.
Result<Done> write_gltf(Document document, const BufferBuilder& added, const std::filesystem::path& output);

}  // namespace gltf_radiosity
