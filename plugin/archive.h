// An archive: named arrays of plain numbers in one file, mapped into memory when it is read.
//
// For what takes long to compute and is wanted again: caches, transport. Nothing in the file is believed before it has
// been checked: what is cut off, damaged, of another version or of another machine's byte order is an error that says
// which chunk it is and why. archive_writer.h writes, archive_format.h draws it.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "plugin/mapped_file.h"
#include "plugin/result.h"

namespace gltf_radiosity {

/// What an archive holds, and in which version of that.
struct ArchiveKind {
  std::string_view name;  ///< at most 23 bytes
  std::uint32_t version = 1;
};

/// What a chunk can hold: values whose bytes are all there is to them.
template <typename T>
concept ArchiveValue = std::is_trivially_copyable_v<T> && alignof(T) <= alignof(std::max_align_t);

/// The values of a chunk: in the mapped file, or unpacked from it. Stay valid without the archive.
template <ArchiveValue T>
struct Chunk {
  std::span<const T> values;
  std::shared_ptr<const void> owner;
};

/// An open archive. Thread-safe.
class Archive {
 public:
  /// Checks all but the chunks, which are checked when they are read. Every error is kBadInput at `path`.
  static Result<Archive> open(const std::filesystem::path& path, const ArchiveKind& kind);

  bool holds(std::string_view name) const;
  /// Bytes of the file.
  std::uint64_t size() const { return file_->bytes().size(); }

  /// The values of a chunk, checked against its checksum.
  template <ArchiveValue T>
  Result<Chunk<T>> read(std::string_view name) const {
    Result<Chunk<std::uint8_t>> raw = read_bytes(name, sizeof(T));
    if (!raw) return raw.error();
    const std::span bytes = raw->values;
    return Chunk<T>{{reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)}, std::move(raw->owner)};
  }

  /// A copy of the values of a chunk.
  template <ArchiveValue T>
  Result<std::vector<T>> read_vector(std::string_view name) const {
    const Result<Chunk<T>> chunk = read<T>(name);
    if (!chunk) return chunk.error();
    return std::vector<T>(chunk->values.begin(), chunk->values.end());
  }

  /// The only value of a chunk.
  template <ArchiveValue T>
  Result<T> read_value(std::string_view name) const {
    const Result<Chunk<T>> chunk = read<T>(name);
    if (!chunk) return chunk.error();
    if (chunk->values.size() != 1) return damaged(name, "holds more or less than one value");
    return chunk->values.front();
  }

  Result<std::string> read_text(std::string_view name) const;

  /// The error to return where the values of a chunk make no sense.
  Error damaged(std::string_view chunk, std::string_view why) const;

 private:
  struct Place {
    std::string name;
    std::span<const std::uint8_t> stored;
    std::uint64_t bytes = 0;
    std::uint64_t checksum = 0;
    std::uint32_t value_bytes = 0;
    bool packed = false;
  };

  Archive(const std::filesystem::path& path, MappedFile file)
      : path_(path.string()), file_(std::make_shared<const MappedFile>(std::move(file))) {}
  Result<Done> check_header(const ArchiveKind& kind);
  Result<Done> read_directory(std::span<const std::uint8_t> directory, std::uint64_t directory_offset);
  const Place* find(std::string_view name) const;
  Result<Chunk<std::uint8_t>> read_bytes(std::string_view name, std::size_t value_bytes) const;

  std::string path_;
  std::shared_ptr<const MappedFile> file_;
  std::vector<Place> places_;  ///< in the order of the file
};

}  // namespace gltf_radiosity
