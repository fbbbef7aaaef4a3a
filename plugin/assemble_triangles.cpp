#include "plugin/assemble_triangles.h"

namespace gltf_radiosity {

std::vector<glm::uvec3> assemble_triangles(std::span<const std::uint32_t> order, int mode) {
  std::vector<glm::uvec3> triangles;
  if (order.size() < 3) return triangles;
  if (mode == kTriangleList) {
    triangles.reserve(order.size() / 3);
    for (std::size_t i = 0; i + 2 < order.size(); i += 3) triangles.emplace_back(order[i], order[i + 1], order[i + 2]);
  } else if (mode == kTriangleStrip) {
    for (std::size_t i = 0; i + 2 < order.size(); ++i) {
      triangles.emplace_back(order[i], order[i + 1 + i % 2], order[i + 2 - i % 2]);
    }
  } else {
    for (std::size_t i = 0; i + 2 < order.size(); ++i) triangles.emplace_back(order[i + 1], order[i + 2], order[0]);
  }
  return triangles;
}

}  // namespace gltf_radiosity
