// Which vertices share a position.
//
// glTF splits a vertex wherever a normal, a texture coordinate or a material changes. Light does not care about
// texture coordinates, and a crack-free subdivision must split both sides of such a seam at the same points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace radiosity {

/// Vertices at one position form a weld class, numbered by first appearance.
struct Weld {
  std::vector<std::uint32_t> class_of_vertex;  ///< [vertex_count]
  std::uint32_t class_count = 0;
};

/// Groups vertices whose positions are equal (-0 equals 0; no tolerance: what touches in glTF is stored equal).
/// REQUIRES: finite positions. Deterministic; linear time.
Weld weld(std::span<const glm::vec3> positions);

/// The same for positions that come one at a time.
class Welder {
 public:
  /// `expected_count` positions fit before the table grows.
  explicit Welder(std::size_t expected_count);

  /// The class of what lies at `position`; a new one if nothing did. REQUIRES: finite.
  std::uint32_t class_of(const glm::vec3& position);

  /// Where each class is, [class_count], metres. Valid until the next class_of().
  std::span<const glm::vec3> positions() const { return positions_; }

 private:
  void grow();

  std::vector<glm::vec3> positions_;
  std::vector<std::uint32_t> class_in_slot_;  ///< open addressing, at most half full, a power of two
};

}  // namespace radiosity
