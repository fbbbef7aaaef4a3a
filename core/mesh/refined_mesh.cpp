#include "core/mesh/refined_mesh.h"

#include <glm/geometric.hpp>
#include <numeric>

namespace radiosity {

RefinedMesh unrefined(const Scene& scene) {
  RefinedMesh mesh;
  mesh.scene_vertex_count = static_cast<std::uint32_t>(scene.positions.size());
  mesh.positions = scene.positions;
  mesh.normals = scene.normals;
  mesh.elements = scene.triangles;
  mesh.triangle_of_element.resize(scene.triangles.size());
  std::iota(mesh.triangle_of_element.begin(), mesh.triangle_of_element.end(), 0U);
  mesh.part_of_element.resize(scene.triangles.size());
  return mesh;
}

float element_area(const RefinedMesh& mesh, std::uint32_t element) {
  const glm::uvec3& corners = mesh.elements[element];
  const glm::vec3& a = mesh.positions[corners.x];
  return 0.5F * glm::length(glm::cross(mesh.positions[corners.y] - a, mesh.positions[corners.z] - a));
}

}  // namespace radiosity
