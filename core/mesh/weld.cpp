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

/// Where the class at `position` is in the table, or the free slot where it belongs.
std::size_t slot_of(const glm::vec3& position, std::span<const glm::vec3> positions,
                    std::span<const std::uint32_t> class_in_slot) {
  const std::size_t last = class_in_slot.size() - 1;
  std::size_t slot = hash_of(position) & last;
  while (class_in_slot[slot] != kNothing && positions[class_in_slot[slot]] != position) {
    slot = (slot + 1) & last;
  }
  return slot;
}

}  // namespace

Welder::Welder(std::size_t expected_count) : class_in_slot_(std::bit_ceil(2 * expected_count + 2), kNothing) {
  positions_.reserve(expected_count);
}

std::uint32_t Welder::class_of(const glm::vec3& position) {
  if (2 * (positions_.size() + 1) > class_in_slot_.size()) {
    grow();
  }
  const std::size_t slot = slot_of(position, positions_, class_in_slot_);
  if (class_in_slot_[slot] == kNothing) {
    class_in_slot_[slot] = static_cast<std::uint32_t>(positions_.size());
    positions_.push_back(position);
  }
  return class_in_slot_[slot];
}

void Welder::grow() {
  class_in_slot_.assign(2 * class_in_slot_.size(), kNothing);
  for (std::uint32_t i = 0; i < positions_.size(); ++i) {
    class_in_slot_[slot_of(positions_[i], positions_, class_in_slot_)] = i;
  }
}

Weld weld(std::span<const glm::vec3> positions) {
  Welder welder(positions.size());
  Weld result;
  result.class_of_vertex.reserve(positions.size());
  for (const glm::vec3& position : positions) {
    result.class_of_vertex.push_back(welder.class_of(position));
  }
  result.class_count = static_cast<std::uint32_t>(welder.positions().size());
  return result;
}

}  // namespace radiosity
