#include "core/visibility/item_buffer.h"

#include <bit>
#include <cstddef>

namespace radiosity {
namespace {

/// Mixes the bits of one more word into a hash; the constants and shifts are those of MurmurHash3 (Appleby, 2011).
std::uint32_t mix(std::uint32_t hash, std::uint32_t word) {
  word *= 0xcc9e2d51U;
  word = std::rotl(word, 15);
  word *= 0x1b873593U;
  hash = std::rotl(hash ^ word, 13);
  return hash * 5U + 0xe6546b64U;
}

std::uint32_t finish(std::uint32_t hash) {
  hash ^= hash >> 16U;
  hash *= 0x85ebca6bU;
  hash ^= hash >> 13U;
  hash *= 0xc2b2ae35U;
  return hash ^ (hash >> 16U);
}

}  // namespace

void ItemBuffer::resize(int cell_count) {
  const auto size = static_cast<std::size_t>(cell_count);
  triangle.resize(size);
  barycentrics.resize(size);
  back.resize(size);
}

float opacity_threshold(const Viewpoint& viewpoint, int cell) {
  // A random shift for each viewpoint, and golden ratio steps from cell to cell: neighbours differ as much as they can,
  // so that even a small half-opaque surface lets half of its cells through.
  std::uint32_t shift = 0;
  for (const float coordinate : {viewpoint.position.x, viewpoint.position.y, viewpoint.position.z, viewpoint.twist}) {
    shift = mix(shift, std::bit_cast<std::uint32_t>(coordinate));
  }
  constexpr std::uint32_t kGoldenRatio = 0x9e3779b9U;
  const std::uint32_t fraction = finish(shift) + static_cast<std::uint32_t>(cell) * kGoldenRatio;
  return static_cast<float>(fraction >> 8U) * 0x1p-24F;
}

}  // namespace radiosity
