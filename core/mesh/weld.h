// Which vertices share a position.
//
// glTF splits a vertex wherever a normal, a texture coordinate or a material changes. Light does not care about
// texture coordinates, and a crack-free subdivision must split both sides of such a seam at the same points.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace radiosity {

/// Vertices at one position form a weld class, numbered by first appearance.
struct Weld {
  std::vector<std::uint32_t> class_of_vertex;  ///< [vertex_count]
  std::uint32_t class_count = 0;
};

/// Groups vertices whose positions are equal (-0 equals 0; no tolerance: what touches in glTF is stored equal).
/// REQUIRES: finite positions. Deterministic; linear time.
Weld weld(std::span<const glm::vec3> positions);

}  // namespace radiosity
