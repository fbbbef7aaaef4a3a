// A finished bake <-> an archive.
#pragma once

#include "core/bake.h"
#include "plugin/archive.h"
#include "plugin/archive_writer.h"

namespace gltf_radiosity {

/// Another BakeReport is another version.
inline constexpr ArchiveKind kBakeArchive{"light", 2};

/// `bake` must stay where it is until the archive is written.
void add_bake(ArchiveWriter& archive, const radiosity::Bake& bake);

/// The same bake, to the last byte; an error if it cannot be one of a scene of so many vertices and triangles.
Result<radiosity::Bake> read_bake(const Archive& archive, std::size_t scene_vertex_count,
                                  std::size_t scene_triangle_count);

}  // namespace gltf_radiosity
