// Files that appear whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "plugin/result.h"

namespace gltf_radiosity {

/// Files written beside their targets under temporary names and renamed together at the end. What was not renamed is
/// removed by the destructor, and so are folders made for it.
class PendingFiles {
 public:
  PendingFiles() = default;
  ~PendingFiles();
  PendingFiles(const PendingFiles&) = delete;
  PendingFiles& operator=(const PendingFiles&) = delete;

  /// Writes the bytes and flushes them to the disk. Makes the folder of `target` if there is none. A target that exists
  /// must be a file; a symbolic link to one stays.
  Result<Done> add(const std::filesystem::path& target, std::span<const std::uint8_t> bytes);
  Result<Done> add(const std::filesystem::path& target, std::string_view text);
  /// The bytes of all `parts` in a row.
  Result<Done> add_parts(const std::filesystem::path& target, std::span<const std::span<const std::uint8_t>> parts);

  /// Renames the files in the order they were added: add last what refers to the others.
  Result<Done> commit();

 private:
  struct File {
    std::filesystem::path temporary, target;
  };

  void make_folder(const std::filesystem::path& folder);

  std::vector<File> files_;
  std::vector<std::filesystem::path> folders_;
};

}  // namespace gltf_radiosity
