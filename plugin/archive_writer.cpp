#include "plugin/archive_writer.h"

#include <xxhash.h>
#include <zstd.h>

#include <cassert>
#include <cstring>
#include <new>

#include "plugin/archive_format.h"
#include "plugin/pending_files.h"

namespace gltf_radiosity {
namespace {

using archive_format::Entry;
using archive_format::Header;

/// The fastest: levels up to 9 take up to ten times as long for a fifth less.
constexpr int kZstdLevel = 1;

/// As they are where packing does not pay.
std::vector<std::uint8_t> packed_by_zstd(std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> result(::ZSTD_compressBound(bytes.size()));
  const std::size_t size = ::ZSTD_compress(result.data(), result.size(), bytes.data(), bytes.size(), kZstdLevel);
  if (::ZSTD_isError(size) != 0) throw std::bad_alloc();  // it has room for everything, so nothing else can go wrong
  if (size > bytes.size() - bytes.size() / 20) return {bytes.begin(), bytes.end()};
  result.resize(size);
  result.shrink_to_fit();
  return result;
}

template <typename T>
std::span<const std::uint8_t> bytes_of_object(const T& object) {
  return {reinterpret_cast<const std::uint8_t*>(&object), sizeof(T)};
}

template <std::size_t size>
void put_name(char (&field)[size], std::string_view name) {
  assert(name.size() < size);
  std::memcpy(field, name.data(), std::min(name.size(), size - 1));
}

}  // namespace

void ArchiveWriter::add_bytes(std::string_view name, std::span<const std::uint8_t> bytes, std::size_t value_bytes,
                              Packing packing) {
  Item item{std::string(name), bytes, {}, bytes.size(), static_cast<std::uint32_t>(value_bytes), false};
  if (packing == Packing::kZstd) item.own = packed_by_zstd(bytes);
  item.packed = item.own.size() < bytes.size() && packing == Packing::kZstd;
  items_.push_back(std::move(item));
}

void ArchiveWriter::add_copy(std::string_view name, std::span<const std::uint8_t> bytes, std::size_t value_bytes) {
  items_.push_back({std::string(name),
                    {},
                    {bytes.begin(), bytes.end()},
                    bytes.size(),
                    static_cast<std::uint32_t>(value_bytes),
                    false});
}

Result<Done> ArchiveWriter::write(const std::filesystem::path& target) const {
  // Where everything goes.
  std::vector<Entry> directory;
  std::uint64_t end = archive_format::kFirstChunk;
  for (const Item& item : items_) {
    const std::span<const std::uint8_t> stored = item.stored();
    Entry& entry = directory.emplace_back();
    put_name(entry.name, item.name);
    entry.offset = archive_format::aligned(end);
    entry.stored_bytes = stored.size();
    entry.bytes = item.bytes;
    entry.checksum = ::XXH3_64bits(stored.data(), stored.size());
    entry.value_bytes = item.value_bytes;
    entry.stored = item.packed ? archive_format::Stored::kZstd : archive_format::Stored::kPlain;
    end = entry.offset + entry.stored_bytes;
  }

  // The header.
  const std::uint64_t directory_bytes = directory.size() * sizeof(Entry);
  Header header = {};
  std::memcpy(header.magic, archive_format::kMagic, sizeof(header.magic));
  header.byte_order = archive_format::kByteOrder;
  header.version = archive_format::kVersion;
  put_name(header.kind, kind_name_);
  header.kind_version = kind_version_;
  header.chunk_count = directory.size();
  header.directory_offset = archive_format::aligned(end);
  header.file_bytes = header.directory_offset + directory_bytes;
  header.directory_checksum = ::XXH3_64bits(directory.data(), directory_bytes);
  header.header_checksum = ::XXH3_64bits(&header, offsetof(Header, header_checksum));

  // All of it in a row.
  static constexpr std::uint8_t kZeros[archive_format::kFirstChunk] = {};
  std::vector<std::span<const std::uint8_t>> parts{
      bytes_of_object(header), std::span(kZeros).first(archive_format::kFirstChunk - sizeof(Header))};
  std::uint64_t written = archive_format::kFirstChunk;
  const auto put_at = [&](std::uint64_t offset, std::span<const std::uint8_t> bytes) {
    parts.push_back(std::span(kZeros).first(offset - written));
    parts.push_back(bytes);
    written = offset + bytes.size();
  };
  for (std::size_t i = 0; i < items_.size(); ++i) put_at(directory[i].offset, items_[i].stored());
  put_at(header.directory_offset, {reinterpret_cast<const std::uint8_t*>(directory.data()), directory_bytes});

  PendingFiles files(target);
  if (auto added = files.add_parts(target, parts); !added) return added;
  return files.commit();
}

}  // namespace gltf_radiosity
