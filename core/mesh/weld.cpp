#include "core/mesh/weld.h"

#include <bit>
#include <cstddef>

#include "core/scene.h"

namespace radiosity {
namespace {

/// Mixes the bits of a position; -0 + 0 is +0, so both zeros hash alike.
std::size_t hash_of(const glm::vec3& position) {
  std::uint64_t hash = 0;
  for (int axis = 0; axis < 3; ++axis) {
    hash ^= std::bit_cast<std::uint32_t>(position[axis] + 0.0F);
    hash *= 0x9e3779b97f4a7c15ULL;
    hash ^= hash >> 32U;
  }
  return static_cast<std::size_t>(hash);
}

}  // namespace

Weld weld(std::span<const glm::vec3> positions) {
  Weld result;
  result.class_of_vertex.reserve(positions.size());

  // An open-addressing table at most half full: each slot holds the first vertex of a class.
  const std::size_t slot_count = std::bit_ceil(2 * positions.size() + 1);
  std::vector<std::uint32_t> first_vertex_in_slot(slot_count, kNothing);

  for (std::uint32_t vertex = 0; vertex < positions.size(); ++vertex) {
    std::size_t slot = hash_of(positions[vertex]) & (slot_count - 1);
    while (first_vertex_in_slot[slot] != kNothing && positions[first_vertex_in_slot[slot]] != positions[vertex]) {
      slot = (slot + 1) & (slot_count - 1);
    }
    if (first_vertex_in_slot[slot] == kNothing) {
      first_vertex_in_slot[slot] = vertex;
      result.class_of_vertex.push_back(result.class_count++);
    } else {
      result.class_of_vertex.push_back(result.class_of_vertex[first_vertex_in_slot[slot]]);
    }
  }
  return result;
}

}  // namespace radiosity
