// A file in memory without reading it: pages come from the disk as they are looked at.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "plugin/result.h"

namespace gltf_radiosity {

/// A read-only view of a whole file. A file that is replaced by a rename or removed stays what it was; one that is
/// truncated in place must not be looked at any more, but no program of this project writes so.
///
/// Thread-safe once opened.
class MappedFile {
 public:
  /// ErrorCode::kBadInput if there is no such file, if it cannot be read or if it is no regular file.
  static Result<MappedFile> open(const std::filesystem::path& path);

  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile();

  std::span<const std::uint8_t> bytes() const { return bytes_; }

 private:
  explicit MappedFile(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::span<const std::uint8_t> bytes_;
};

}  // namespace gltf_radiosity
