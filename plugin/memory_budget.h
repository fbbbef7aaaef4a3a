// How much memory a bake may take, and what of it is spoken for.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

#include "plugin/result.h"

namespace gltf_radiosity {

/// Memory is set aside before it is taken, by what the input says: so a file that claims four billion vertices is
/// refused before anything is done for them.
class MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t limit = std::numeric_limits<std::uint64_t>::max()) : limit_(limit) {}

  /// Sets memory aside for `count` `things` of so many bytes each; an error of ErrorCode::kLimit that names `place` if
  /// there is not enough left. Counts may be anything: products do not overflow.
  Result<Done> reserve(std::uint64_t count, std::uint64_t bytes_each, const std::string& place,
                       std::string_view things);
  /// The same for what is gone again soon.
  Result<Done> check(std::uint64_t count, std::uint64_t bytes_each, const std::string& place,
                     std::string_view things) const;

  std::uint64_t limit() const { return limit_; }
  std::uint64_t left() const { return limit_ - reserved_; }

 private:
  std::uint64_t limit_;
  std::uint64_t reserved_ = 0;  ///< at most limit_
};

/// Three quarters of the machine's memory, or of what the control groups of this process (containers, batch systems)
/// may have. `system` is where proc and sys lie.
std::uint64_t allowed_memory(const std::filesystem::path& system = "/");

}  // namespace gltf_radiosity
