// A folder of results that are wanted again, shared by any number of processes.
//
// Entries are archives (archive.h) named after what they hold and the hash of what they follow from. They appear whole
// or not at all and are never changed, so that readers and writers need no locks; what was used longest ago goes first
// when there is too much.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "plugin/archive.h"
#include "plugin/archive_writer.h"
#include "plugin/gltf_radiosity.h"

namespace gltf_radiosity {

/// Not thread-safe; other processes do not matter.
class CacheFolder {
 public:
  /// Makes the folder if there is none. ErrorCode::kCannotWrite. `warnings` must outlive it.
  static Result<CacheFolder> open(const std::filesystem::path& folder, std::uint64_t max_bytes,
                                  std::vector<Warning>& warnings);

  /// Whatever `read`, from an Archive to a Result, makes of the entry `kind` of `hash`; nothing if there is none, or if
  /// it is damaged: then a warning says so, and the next store() replaces it.
  template <typename Read>
  auto load(const ArchiveKind& kind, const std::string& hash, const Read& read) const
      -> std::optional<std::decay_t<decltype(*read(std::declval<const Archive&>()))>> {
    const std::optional<Archive> archive = find(kind, hash);
    if (!archive) return std::nullopt;
    auto result = read(*archive);
    if (result) return std::move(*result);
    warn_of_damage(result.error());
    return std::nullopt;
  }

  /// Puts an entry into the folder and makes room for it. What cannot be written is a warning.
  void store(const ArchiveKind& kind, const std::string& hash, const ArchiveWriter& entry);

 private:
  CacheFolder(std::filesystem::path folder, std::uint64_t max_bytes, std::vector<Warning>& warnings)
      : folder_(std::move(folder)), max_bytes_(max_bytes), warnings_(&warnings) {}
  std::filesystem::path path_of(const ArchiveKind& kind, const std::string& hash) const;
  std::optional<Archive> find(const ArchiveKind& kind, const std::string& hash) const;
  void warn_of_damage(const Error& error) const;
  void evict() const;

  std::filesystem::path folder_;
  std::uint64_t max_bytes_;
  std::vector<Warning>* warnings_;
};

}  // namespace gltf_radiosity
