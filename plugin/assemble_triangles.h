// Lists, strips and fans of vertices -> triangles.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace gltf_radiosity {

// glTF's numbers for the modes of a primitive that are made of triangles.
inline constexpr int kTriangleList = 4, kTriangleStrip = 5, kTriangleFan = 6;

/// Triangles of a list of vertices drawn in `mode` (glTF 2.0, section 3.7.2.1). REQUIRES: one of the modes above.
std::vector<glm::uvec3> assemble_triangles(std::span<const std::uint32_t> order, int mode);

}  // namespace gltf_radiosity
