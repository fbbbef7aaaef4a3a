#include "core/mesh/refined_mesh.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

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

void append_cuts(const RefinedMesh& mesh, std::vector<Rgb>& values) {
  for (std::size_t v = values.size(); v < mesh.positions.size(); ++v) {
    const Cut& cut = mesh.cuts[v - mesh.scene_vertex_count];
    values.push_back(glm::mix(values[cut.ends.x], values[cut.ends.y], cut.at));
  }
}

void group_by_triangle(RefinedMesh& mesh, std::size_t triangle_count) {
  // Counting sort: where the elements of each triangle begin.
  std::vector<std::uint32_t> next_of_triangle(triangle_count + 1, 0);
  for (const std::uint32_t triangle : mesh.triangle_of_element) ++next_of_triangle[triangle + std::size_t{1}];
  std::partial_sum(next_of_triangle.begin(), next_of_triangle.end(), next_of_triangle.begin());

  const std::vector<glm::uvec3> elements = std::move(mesh.elements);
  const std::vector<std::uint32_t> triangles = std::move(mesh.triangle_of_element);
  const std::vector<SubTriangle> parts = std::move(mesh.part_of_element);
  mesh.elements.resize(elements.size());
  mesh.triangle_of_element.resize(elements.size());
  mesh.part_of_element.resize(elements.size());
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const std::uint32_t to = next_of_triangle[triangles[e]]++;
    mesh.elements[to] = elements[e];
    mesh.triangle_of_element[to] = triangles[e];
    mesh.part_of_element[to] = parts[e];
  }
}

float element_area(const RefinedMesh& mesh, std::uint32_t element) {
  const glm::uvec3& corners = mesh.elements[element];
  const glm::vec3& a = mesh.positions[corners.x];
  return 0.5F * glm::length(glm::cross(mesh.positions[corners.y] - a, mesh.positions[corners.z] - a));
}

}  // namespace radiosity
