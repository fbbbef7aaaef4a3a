#include "core/mesh/cut_mesh.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace radiosity {
namespace {

/// Halfway between two positions, the same from either end.
glm::vec3 midpoint(const glm::vec3& a, const glm::vec3& b) { return 0.5F * a + 0.5F * b; }

/// A shading normal between two, of unit length again; zero if either is (shaded flat).
glm::vec3 normal_between(const glm::vec3& a, const glm::vec3& b, float at) {
  if (a == glm::vec3(0.0F) || b == glm::vec3(0.0F)) {
    return glm::vec3(0.0F);
  }
  const glm::vec3 sum = (1.0F - at) * a + at * b;
  const float length = glm::length(sum);
  return length > 0.0F ? sum / length : a;  // opposite normals have no middle
}

double squared_distance(const glm::vec3& a, const glm::vec3& b) {
  const double x = static_cast<double>(a.x) - static_cast<double>(b.x);
  const double y = static_cast<double>(a.y) - static_cast<double>(b.y);
  const double z = static_cast<double>(a.z) - static_cast<double>(b.z);
  return x * x + y * y + z * z;
}

std::vector<std::uint32_t> classes_of(const Scene& scene, Welder& welder) {
  std::vector<std::uint32_t> class_of_vertex;
  class_of_vertex.reserve(scene.positions.size());
  for (const glm::vec3& position : scene.positions) {
    class_of_vertex.push_back(welder.class_of(position));
  }
  return class_of_vertex;
}

}  // namespace

std::uint64_t pair_key(const glm::uvec2& pair) {
  return std::uint64_t{std::min(pair.x, pair.y)} << 32U | std::max(pair.x, pair.y);
}

CutMesh::CutMesh(const Scene& scene)
    : welder(scene.positions.size()),
      class_of_vertex(classes_of(scene, welder)),
      bridge(scene.triangles, class_of_vertex, welder.positions()),
      mesh(unrefined(scene)) {}

double CutMesh::squared_length(const glm::uvec2& end_classes) const {
  return squared_distance(welder.positions()[end_classes.x], welder.positions()[end_classes.y]);
}

bool CutMesh::can_be_halved(const glm::uvec2& end_classes) const {
  const glm::vec3& a = welder.positions()[end_classes.x];
  const glm::vec3& b = welder.positions()[end_classes.y];
  const glm::vec3 middle = midpoint(a, b);
  return middle != a && middle != b;
}

std::uint32_t CutMesh::add_midpoint(const glm::uvec2& ends) {
  const glm::uvec2 in_order(std::min(ends.x, ends.y), std::max(ends.x, ends.y));
  mesh.cuts.push_back({in_order, 0.5F});
  mesh.positions.push_back(midpoint(mesh.positions[ends.x], mesh.positions[ends.y]));
  mesh.normals.push_back(normal_between(mesh.normals[in_order.x], mesh.normals[in_order.y], 0.5F));
  return static_cast<std::uint32_t>(mesh.positions.size()) - 1;
}

std::uint32_t CutMesh::add_cut(const Cut& cut, std::uint32_t position_class) {
  mesh.cuts.push_back(cut);
  mesh.positions.push_back(welder.positions()[position_class]);
  mesh.normals.push_back(normal_between(mesh.normals[cut.ends.x], mesh.normals[cut.ends.y], cut.at));
  return static_cast<std::uint32_t>(mesh.positions.size()) - 1;
}

std::uint32_t CutMesh::class_between(const glm::uvec2& end_classes, float at) {
  const glm::vec3& a = welder.positions()[end_classes.x];
  const glm::vec3& b = welder.positions()[end_classes.y];
  return welder.class_of((1.0F - at) * a + at * b);
}

std::uint32_t CutMesh::add_between(const glm::uvec2& ends, const glm::uvec2& end_classes, float at,
                                   std::uint32_t position_class) {
  const bool starts_at_first = mesh.positions[ends.x] == welder.positions()[end_classes.x];
  const Cut cut{ends, starts_at_first ? at : 1.0F - at};
  return add_cut(ends.x < ends.y ? cut : Cut{{ends.y, ends.x}, 1.0F - cut.at}, position_class);
}

void CutMesh::set_side(std::uint32_t vertex, std::uint32_t side) {
  mesh.side_of_seam.resize(mesh.positions.size(), 0);
  mesh.side_of_seam[vertex] = side;
}

bool CutMesh::split_seam(const glm::uvec2& end_classes, std::uint32_t middle_class) {
  if (seams.erase(pair_key(end_classes)) == 0) return false;
  seams.insert(pair_key({end_classes.x, middle_class}));
  seams.insert(pair_key({end_classes.y, middle_class}));
  return true;
}

std::array<std::uint32_t, 2> CutMesh::halve(std::uint32_t edge, const std::array<std::uint32_t, 2>& midpoint_of_side) {
  const std::uint32_t middle = class_between(bridge.end_classes(edge), 0.5F);
  return bridge.cut(edge, 0.5F, middle, welder.positions()[middle], midpoint_of_side);
}

}  // namespace radiosity
