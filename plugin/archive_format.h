// How an archive lies on the disk. For archive.cpp and archive_writer.cpp only.
//
//     +--------+---------+---------+-- - - --+---------+-----------+
//     | header | chunk 0 | chunk 1 |         | chunk n | directory |
//     +--------+---------+---------+-- - - --+---------+-----------+
//     0        128       each begins at a multiple of 64          end of the file
//
// Numbers are stored as the machine has them; the header says in which order. Everything but the padding between chunks
// stands under a checksum: the header under its own, the directory under one in the header, each chunk under one in
// the directory.
#pragma once

#include <cstddef>
#include <cstdint>

namespace gltf_radiosity::archive_format {

/// As PNG does it: a program that mends line ends or takes bytes for text breaks it at once.
inline constexpr char kMagic[8] = {'\x89', 'r', 'a', 'd', '\r', '\n', '\x1a', '\n'};
inline constexpr std::uint32_t kByteOrder = 0x01020304U;
inline constexpr std::uint32_t kOtherByteOrder = 0x04030201U;
inline constexpr std::uint32_t kVersion = 1;
inline constexpr std::uint64_t kAlignment = 64;
/// Zstandard packs 128 KiB into 4 bytes at best.
inline constexpr std::uint64_t kMaxExpansion = 32768;

enum class Stored : std::uint32_t { kPlain, kZstd };

struct Header {
  char magic[8];
  std::uint32_t byte_order;
  std::uint32_t version;
  char kind[24];  ///< zero at its end
  std::uint32_t kind_version;
  std::uint32_t reserved;
  std::uint64_t file_bytes;
  std::uint64_t chunk_count;
  std::uint64_t directory_offset;
  std::uint64_t directory_checksum;
  std::uint64_t header_checksum;  ///< of all that stands before it
};
static_assert(sizeof(Header) == 88 && offsetof(Header, header_checksum) == 80);

struct Entry {
  char name[40];  ///< zero at its end
  std::uint64_t offset;
  std::uint64_t stored_bytes;
  std::uint64_t bytes;     ///< of the values
  std::uint64_t checksum;  ///< of what is stored
  std::uint32_t value_bytes;
  Stored stored;
};
static_assert(sizeof(Entry) == 80);

/// Where the first chunk begins.
inline constexpr std::uint64_t kFirstChunk = 128;

constexpr std::uint64_t aligned(std::uint64_t offset) { return (offset + kAlignment - 1) / kAlignment * kAlignment; }

}  // namespace gltf_radiosity::archive_format
