// A patched document -> bytes -> files that appear whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "plugin/append_accessor.h"
#include "plugin/document.h"
#include "plugin/pending_files.h"

namespace gltf_radiosity {

/// How a glTF is stored, by the end of the file's name (upper or lower case).
enum class FileKind {
  kGlb,       ///< .glb
  kGltf,      ///< .gltf with a .bin beside it
  kEmbedded,  ///< .embedded.gltf: everything as data URIs
};
std::optional<FileKind> file_kind(const std::filesystem::path& output);

/// The length of a GLB is stored in 32 bits.
inline constexpr std::uint64_t kMaxGlbBytes = 0xffffffffU;

/// The document as one GLB: all buffers merged into the binary chunk, external images embedded, bytes untouched.
/// `added` is the last buffer, [document.buffers.size()]. More than `max_bytes` is an error.
Result<Bytes> to_glb(Document document, const BufferBuilder& added, std::uint64_t max_bytes = kMaxGlbBytes);

/// Whether `output` can be written, as far as that shows beforehand: a known kind, in a folder that exists and can be
/// written to, not something else than a file.
Result<Done> check_output(const std::filesystem::path& output);

/// Adds a file of the kind its name says to those that are to appear, what it refers to before it. Images that lie
/// outside the output's folder are copied into it; no file that holds something else is overwritten by that. The .bin
/// has a name that depends on what it holds, so that an old output stays whole until the new one is.
Result<Done> add_gltf(Document document, const BufferBuilder& added, const std::filesystem::path& output,
                      PendingFiles& files);

/// Lets files that were added appear, whole or not at all (pending_files.h), and removes what then is left of old ones
/// (old_bins.h). `outputs`: at least one, all in one folder.
Result<Done> commit_gltfs(PendingFiles& files, std::span<const std::filesystem::path> outputs);

/// Adds one file and lets it appear.
Result<Done> write_gltf(Document document, const BufferBuilder& added, const std::filesystem::path& output);

}  // namespace gltf_radiosity
