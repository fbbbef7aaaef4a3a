// File names that depend on what a file holds: nothing that is there under such a name has to be replaced.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace gltf_radiosity {

/// "wood.png" -> "wood-0123456789abcdef.png", in the same folder.
std::filesystem::path name_by_content(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

/// Whether `name` is one that name_by_content() might make of `original`, whatever the content. Folders do not count.
bool is_name_by_content(const std::filesystem::path& name, const std::filesystem::path& original);

}  // namespace gltf_radiosity
