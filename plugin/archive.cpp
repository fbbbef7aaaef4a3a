#include "plugin/archive.h"

#include <fmt/format.h>
#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <optional>

#include "plugin/archive_format.h"

namespace gltf_radiosity {
namespace {

using archive_format::Entry;
using archive_format::Header;
using archive_format::Stored;

/// The text of a field that ends with zero; nothing if it does not.
template <std::size_t size>
std::optional<std::string> text_of_field(const char (&field)[size]) {
  const char* const end = std::find(field, field + size, '\0');
  if (end == field + size) return std::nullopt;
  return std::string(field, end);
}

/// What is wrong with an entry of the directory; `from` is where the entry before it ends.
const char* wrong_with(const Entry& entry, std::uint64_t from, std::uint64_t directory_offset) {
  if (entry.offset != archive_format::aligned(from)) return "it does not begin where the one before it ends";
  if (entry.offset > directory_offset || entry.stored_bytes > directory_offset - entry.offset) {
    return "it reaches beyond the end of the file";
  }
  if (entry.value_bytes == 0 || entry.bytes % entry.value_bytes != 0) return "its values have no whole number of bytes";
  if (entry.stored == Stored::kPlain && entry.bytes != entry.stored_bytes) return "its size is wrong";
  if (entry.stored == Stored::kZstd && entry.bytes / archive_format::kMaxExpansion > entry.stored_bytes) {
    return "it claims more than it can hold";
  }
  return entry.stored > Stored::kZstd ? "it is packed in an unknown way" : nullptr;
}

}  // namespace

Error Archive::damaged(std::string_view chunk, std::string_view why) const {
  return bad_input(path_, fmt::format("chunk '{}' is damaged: {}", chunk, why));
}

Result<Archive> Archive::open(const std::filesystem::path& path, const ArchiveKind& kind) {
  Result<MappedFile> file = MappedFile::open(path);
  if (!file) return file.error();
  Archive archive(path, std::move(*file));
  if (const auto checked = archive.check_header(kind); !checked) return checked.error();
  return archive;
}

Result<Done> Archive::check_header(const ArchiveKind& kind) {
  const auto refuse = [this](std::string why) { return bad_input(path_, std::move(why)); };
  const std::span<const std::uint8_t> bytes = file_->bytes();

  // Whether it is an archive that this program reads.
  const std::size_t magic_bytes = std::min(bytes.size(), sizeof(Header::magic));
  if (magic_bytes == 0 || std::memcmp(bytes.data(), archive_format::kMagic, magic_bytes) != 0) {
    return refuse("is no file of this program");
  }
  if (bytes.size() < archive_format::kFirstChunk) return refuse("is cut off");
  Header header;
  std::memcpy(&header, bytes.data(), sizeof(header));
  if (header.byte_order == archive_format::kOtherByteOrder) return refuse("comes from a machine of another byte order");
  if (header.version != archive_format::kVersion && header.byte_order == archive_format::kByteOrder) {
    return refuse(fmt::format("is an archive of version {}; this program reads version {}", header.version,
                              archive_format::kVersion));
  }
  if (header.header_checksum != ::XXH3_64bits(&header, offsetof(Header, header_checksum))) {
    return refuse("is damaged: the checksum of its header is wrong");
  }
  const std::optional<std::string> name = text_of_field(header.kind);
  if (!name || *name != kind.name || header.kind_version != kind.version) {
    return refuse(fmt::format("is '{}' of version {}; '{}' of version {} is wanted", name.value_or(""),
                              header.kind_version, kind.name, kind.version));
  }

  // Whether it is all there.
  if (header.file_bytes != bytes.size()) {
    return refuse(fmt::format("is cut off: {} of {} bytes are there", bytes.size(), header.file_bytes));
  }
  if (header.directory_offset > bytes.size()) return refuse("is damaged: its directory lies outside of it");
  const std::span<const std::uint8_t> directory = bytes.subspan(header.directory_offset);
  if (directory.size() % sizeof(Entry) != 0 || directory.size() / sizeof(Entry) != header.chunk_count) {
    return refuse("is damaged: the size of its directory is wrong");
  }
  if (header.directory_checksum != ::XXH3_64bits(directory.data(), directory.size())) {
    return refuse("is damaged: the checksum of its directory is wrong");
  }
  return read_directory(directory, header.directory_offset);
}

Result<Done> Archive::read_directory(std::span<const std::uint8_t> directory, std::uint64_t directory_offset) {
  std::uint64_t end = archive_format::kFirstChunk;
  for (std::size_t i = 0; i < directory.size() / sizeof(Entry); ++i) {
    Entry entry;
    std::memcpy(&entry, directory.data() + i * sizeof(Entry), sizeof(entry));
    const std::string name = text_of_field(entry.name).value_or(fmt::format("number {}", i));
    if (const char* const wrong = wrong_with(entry, end, directory_offset)) return damaged(name, wrong);
    end = entry.offset + entry.stored_bytes;
    places_.push_back({name, file_->bytes().subspan(entry.offset, entry.stored_bytes), entry.bytes, entry.checksum,
                       entry.value_bytes, entry.stored == Stored::kZstd});
  }
  return Done{};
}

const Archive::Place* Archive::find(std::string_view name) const {
  const auto place = std::find_if(places_.begin(), places_.end(), [&](const Place& p) { return p.name == name; });
  return place == places_.end() ? nullptr : &*place;
}

bool Archive::holds(std::string_view name) const { return find(name) != nullptr; }

Result<Chunk<std::uint8_t>> Archive::read_bytes(std::string_view name, std::size_t value_bytes) const {
  // What is stored.
  const Place* const place = find(name);
  if (place == nullptr) return bad_input(path_, fmt::format("chunk '{}' is missing", name));
  if (place->value_bytes != value_bytes) {
    return damaged(name, fmt::format("its values have {} bytes instead of {}", place->value_bytes, value_bytes));
  }
  if (place->checksum != ::XXH3_64bits(place->stored.data(), place->stored.size())) {
    return damaged(name, "its checksum is wrong");
  }
  if (!place->packed) return Chunk<std::uint8_t>{place->stored, file_};

  // Unpacked: the frame must say the same size as the directory, and then have it.
  if (::ZSTD_getFrameContentSize(place->stored.data(), place->stored.size()) != place->bytes) {
    return damaged(name, "it does not unpack to its size");
  }
  auto values = std::make_shared<std::vector<std::uint8_t>>(place->bytes);
  const std::size_t size =
      ::ZSTD_decompress(values->data(), values->size(), place->stored.data(), place->stored.size());
  if (size != place->bytes) return damaged(name, "it does not unpack to its size");
  const std::span<const std::uint8_t> unpacked = *values;
  return Chunk<std::uint8_t>{unpacked, std::move(values)};
}

Result<std::string> Archive::read_text(std::string_view name) const {
  const Result<Chunk<char>> chunk = read<char>(name);
  if (!chunk) return chunk.error();
  return std::string(chunk->values.begin(), chunk->values.end());
}

}  // namespace gltf_radiosity
