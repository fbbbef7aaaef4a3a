// The files that a glTF names: regular ones, in its own folder or below, unless the user lets it look elsewhere.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "plugin/result.h"

namespace gltf_radiosity {

/// No bound on what is read but memory.
inline constexpr std::uint64_t kAnySize = std::numeric_limits<std::uint64_t>::max();

/// Where relative URIs start.
struct InputFolder {
  InputFolder() = default;
  InputFolder(std::filesystem::path path_of_folder, bool leave = false)  // NOLINT(google-explicit-constructor)
      : path(std::move(path_of_folder)), may_leave(leave) {}

  std::filesystem::path path;          ///< empty for a glTF from memory, which can name no files
  bool may_leave = false;              ///< absolute paths, `..` and symbolic links may lead out of the folder
  std::uint64_t max_bytes = kAnySize;  ///< of one file; more is ErrorCode::kLimit
};

/// The file behind a relative URI: it exists, is a regular file and lies below `folder`, symbolic links followed.
/// URIs with a scheme (http:, file:, C:) are refused. `place` goes into errors.
Result<std::filesystem::path> resolve_uri(const std::string& uri, const InputFolder& folder, const std::string& place);

/// What the file behind a relative URI holds. Nobody can lead it out of `folder` by exchanging files and links
/// meanwhile.
Result<std::vector<std::uint8_t>> read_file_of_uri(const std::string& uri, const InputFolder& folder,
                                                   const std::string& place);

/// Whether writing `outputs` leaves `inputs` alone: none is the same file, by whatever name or link. An empty name is
/// none.
Result<Done> check_that_inputs_are_spared(std::span<const std::filesystem::path> inputs,
                                          std::span<const std::string> outputs);

/// A file that the user names himself: may lie anywhere and be a pipe. An empty `place` puts its name into errors.
Result<std::vector<std::uint8_t>> read_file(const std::filesystem::path& file, const std::string& place,
                                            std::uint64_t max_bytes = kAnySize);

}  // namespace gltf_radiosity
