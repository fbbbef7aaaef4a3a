// An open file, read and written whole, however many steps the system takes.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace gltf_radiosity {

/// Owns a file descriptor. Functions answer 0 or the errno of what failed; signals in between do not count as failures.
class Descriptor {
 public:
  /// -1 is none.
  explicit Descriptor(int descriptor = -1) : descriptor_(descriptor) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  bool is_open() const { return descriptor_ >= 0; }
  int get() const { return descriptor_; }

  /// Everything from here to the end; EFBIG if that is more than `max_bytes`, before memory is taken where the file
  /// says its size; where it does not, as pipes, if that is more than a quarter.
  int read_all(std::uint64_t max_bytes, std::vector<std::uint8_t>& bytes) const;
  /// Writes all of `bytes`.
  int write_all(std::span<const std::uint8_t> bytes) const;
  /// What was written is on the disk afterwards. Files that cannot be flushed, as pipes, are no failure.
  int flush() const;
  int close();

 private:
  int descriptor_;
};

}  // namespace gltf_radiosity
