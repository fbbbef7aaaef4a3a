// Values -> an archive (archive.h) that appears whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "plugin/archive.h"

namespace gltf_radiosity {

/// How a chunk is stored. Packing takes a second for 200 MB or so and unpacking a fifth of that (docs/decisions/0009).
enum class Packing : std::uint8_t {
  kPlain,  ///< as it is: read without a copy
  kZstd,   ///< smaller; left plain where that saves less than a twentieth
};

/// Collects chunks and writes them. The same chunks give the same bytes.
class ArchiveWriter {
 public:
  explicit ArchiveWriter(const ArchiveKind& kind) : kind_name_(kind.name), kind_version_(kind.version) {}

  /// With kPlain the values must stay where they are until write(); with kZstd they are packed, or copied, at once.
  /// REQUIRES: `name` is new and has at most 39 bytes. Padding within T would be written too: there should be none.
  template <ArchiveValue T>
  void add(std::string_view name, std::span<const T> values, Packing packing) {
    add_bytes(name, bytes_of(values), sizeof(T), packing);
  }
  template <ArchiveValue T>
  void add(std::string_view name, const std::vector<T>& values, Packing packing) {
    add(name, std::span<const T>(values), packing);
  }
  /// These are copied.
  template <ArchiveValue T>
  void add_value(std::string_view name, const T& value) {
    add_copy(name, bytes_of(std::span(&value, 1)), sizeof(T));
  }
  void add_text(std::string_view name, std::string_view text) { add_copy(name, bytes_of(std::span(text)), 1); }

  /// Writes the archive beside `target` and renames it. kCannotWrite.
  Result<Done> write(const std::filesystem::path& target) const;

 private:
  struct Item {
    std::string name;
    std::span<const std::uint8_t> view;  ///< what is stored, unless `own` holds it
    std::vector<std::uint8_t> own;
    std::uint64_t bytes = 0;  ///< of the values
    std::uint32_t value_bytes = 0;
    bool packed = false;

    std::span<const std::uint8_t> stored() const { return own.empty() ? view : std::span(own); }
  };

  template <typename T>
  static std::span<const std::uint8_t> bytes_of(std::span<const T> values) {
    return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size_bytes()};
  }
  void add_bytes(std::string_view name, std::span<const std::uint8_t> bytes, std::size_t value_bytes, Packing packing);
  void add_copy(std::string_view name, std::span<const std::uint8_t> bytes, std::size_t value_bytes);

  std::string kind_name_;
  std::uint32_t kind_version_;
  std::vector<Item> items_;
};

}  // namespace gltf_radiosity
