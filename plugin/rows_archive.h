// Rows of F <-> an archive.
#pragma once

#include <memory>

#include "core/transport/form_factors.h"
#include "plugin/archive.h"
#include "plugin/archive_writer.h"

namespace gltf_radiosity {

inline constexpr ArchiveKind kRowsArchive{"rows", 1};

/// All rows of `rows`, packed: nothing needs to stay. REQUIRES: it holds them all.
void add_rows(ArchiveWriter& archive, const radiosity::RowCache& rows);

/// The same rows; an error if they cannot be those of `patch_count` patches.
Result<std::unique_ptr<radiosity::RowSource>> read_rows(const Archive& archive, std::uint32_t patch_count);

}  // namespace gltf_radiosity
