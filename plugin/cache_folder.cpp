#include "plugin/cache_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <system_error>

namespace gltf_radiosity {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEnding = ".radcache";

/// Older temporary files belong to nobody any more: a process was killed while it wrote.
constexpr auto kAbandonedAfter = std::chrono::hours(24);

struct CacheEntry {
  fs::path path;
  fs::file_time_type used;
  std::uint64_t bytes = 0;
};

/// Our files in the folder, those used longest ago first. What vanishes meanwhile is left out.
std::vector<CacheEntry> entries_in(const fs::path& folder) {
  std::vector<CacheEntry> entries;
  std::error_code error;
  for (auto file = fs::directory_iterator(folder, error); !error && file != fs::end(file); file.increment(error)) {
    if (file->path().filename().string().find(kEnding) == std::string::npos) continue;
    std::error_code gone;
    const CacheEntry entry{file->path(), file->last_write_time(gone), file->file_size(gone)};
    if (!gone) entries.push_back(entry);
  }
  std::sort(entries.begin(), entries.end(), [](const CacheEntry& a, const CacheEntry& b) {
    return std::tie(a.used, a.path) < std::tie(b.used, b.path);
  });
  return entries;
}

}  // namespace

Result<CacheFolder> CacheFolder::open(const fs::path& folder, std::uint64_t max_bytes, std::vector<Warning>& warnings) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder) || ::access(folder.c_str(), R_OK | W_OK | X_OK) != 0) {
    return Error{ErrorCode::kCannotWrite, folder.string(), "cannot be used as a cache: no folder that can be written"};
  }
  return CacheFolder(folder, max_bytes, warnings);
}

fs::path CacheFolder::path_of(const ArchiveKind& kind, const std::string& hash) const {
  return folder_ / fmt::format("{}-{}{}", kind.name, hash, kEnding);
}

std::optional<Archive> CacheFolder::find(const ArchiveKind& kind, const std::string& hash) const {
  const fs::path path = path_of(kind, hash);
  std::error_code error;
  if (!fs::exists(path, error)) return std::nullopt;
  Result<Archive> archive = Archive::open(path, kind);
  if (archive) {
    fs::last_write_time(path, fs::file_time_type::clock::now(), error);  // used now; no matter if it cannot be said
    return std::move(*archive);
  }
  if (fs::exists(path, error)) warn_of_damage(archive.error());  // else another process has just removed it
  return std::nullopt;
}

void CacheFolder::warn_of_damage(const Error& error) const {
  warnings_->push_back({"cache-damaged", error.place, error.message + "; it is computed again"});
}

void CacheFolder::store(const ArchiveKind& kind, const std::string& hash, const ArchiveWriter& entry) {
  if (const auto written = entry.write(path_of(kind, hash)); !written) {
    warnings_->push_back({"cache-not-written", written.error().place, written.error().message});
    return;
  }
  evict();
}

void CacheFolder::evict() const {
  std::vector<CacheEntry> entries = entries_in(folder_);
  const auto now = fs::file_time_type::clock::now();
  std::uint64_t bytes = 0;
  for (const CacheEntry& entry : entries) bytes += entry.bytes;
  for (const CacheEntry& entry : entries) {
    // Temporary files are being written by somebody, unless they are old.
    const bool temporary = !entry.path.filename().string().ends_with(kEnding);
    const bool goes = temporary ? now - entry.used > kAbandonedAfter : bytes > max_bytes_;
    std::error_code gone;
    if (!goes || !fs::remove(entry.path, gone)) continue;
    bytes -= entry.bytes;
  }
}

}  // namespace gltf_radiosity
