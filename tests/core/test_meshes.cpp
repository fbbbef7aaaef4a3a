#include "tests/core/test_meshes.h"

#include <glm/geometric.hpp>

namespace radiosity::test {

void add_grid(RefinedMesh& mesh, int n, const glm::vec3& origin, const glm::vec3& u, const glm::vec3& v) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const auto at = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (n + 1) + i); };
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      mesh.positions.push_back(origin + static_cast<float>(i) / static_cast<float>(n) * u +
                               static_cast<float>(j) / static_cast<float>(n) * v);
      mesh.normals.push_back(glm::normalize(glm::cross(u, v)));
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      mesh.elements.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      mesh.elements.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
}

RefinedMesh grid(int n) {
  RefinedMesh mesh;
  add_grid(mesh, n, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  return mesh;
}

glm::vec3 middle(const RefinedMesh& mesh, std::uint32_t element) {
  const glm::uvec3& t = mesh.elements[element];
  return (mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z]) / 3.0F;
}

double area_of(const SubTriangle& part) {
  const glm::dvec2 u = part.corner[1] - part.corner[0], v = part.corner[2] - part.corner[0];
  return 0.5 * (u.x * v.y - u.y * v.x);
}

bool holds(const SubTriangle& part, Barycentrics at) {
  for (int k = 0; k < 3; ++k) {
    const SubTriangle third{{part.corner[k], part.corner[(k + 1) % 3], at}};
    if (area_of(third) < -1e-6) return false;
  }
  return true;
}

}  // namespace radiosity::test
