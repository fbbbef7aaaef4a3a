#include "tests/core/mesh/conformity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "core/mesh/t_vertices.h"

namespace radiosity::test {
namespace {

using Point = std::tuple<float, float, float>;
using At = std::pair<float, float>;

Point point_of(const glm::vec3& p) { return {p.x + 0.0F, p.y + 0.0F, p.z + 0.0F}; }
At at_of(const Barycentrics& b) { return {b.x, b.y}; }

/// Which edge of its triangle two corners both lie on (0: corner 0 to 1, 1: 1 to 2, 2: 2 to 0), or 3.
int triangle_edge_of(const Barycentrics& a, const Barycentrics& b) {
  if (a.y == 0.0F && b.y == 0.0F) {
    return 0;
  }
  if (a.x + a.y == 1.0F && b.x + b.y == 1.0F) {
    return 1;
  }
  return a.x == 0.0F && b.x == 0.0F ? 2 : 3;
}

class Conformity {
 public:
  Conformity(const Scene& scene, const RefinedMesh& mesh) : scene_(scene), mesh_(mesh) {}

  void check() {
    check_vertices();
    check_elements();
    for (const auto& [directed, count] : elements_at_inner_edge_) {
      const auto& [triangle, from, to] = directed;
      EXPECT_EQ(count, 1) << "elements of triangle " << triangle << " overlap";
      EXPECT_TRUE(elements_at_inner_edge_.contains({triangle, to, from})) << "a gap inside triangle " << triangle;
    }
    for (std::uint32_t triangle = 0; triangle < scene_.triangles.size(); ++triangle) {
      EXPECT_EQ(area_of_triangle_[triangle], 1.0) << "triangle " << triangle << " is not covered exactly";
    }
    check_shared_edges();
  }

 private:
  void check_vertices() {
    ASSERT_EQ(mesh_.scene_vertex_count, scene_.positions.size());
    ASSERT_EQ(mesh_.positions.size(), mesh_.scene_vertex_count + mesh_.cuts.size());
    ASSERT_EQ(mesh_.normals.size(), mesh_.positions.size());
    for (std::size_t i = 0; i < scene_.positions.size(); ++i) {
      ASSERT_EQ(mesh_.positions[i], scene_.positions[i]);
      ASSERT_EQ(mesh_.normals[i], scene_.normals[i]);
    }
    std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (std::size_t k = 0; k < mesh_.cuts.size(); ++k) {
      const glm::uvec2 ends = mesh_.cuts[k].ends;
      ASSERT_LT(std::max(ends.x, ends.y), mesh_.scene_vertex_count + k) << "a midpoint of a later vertex";
      EXPECT_EQ(mesh_.positions[mesh_.scene_vertex_count + k],
                0.5F * mesh_.positions[ends.x] + 0.5F * mesh_.positions[ends.y]);
      EXPECT_TRUE(pairs.insert({std::min(ends.x, ends.y), std::max(ends.x, ends.y)}).second)
          << "two midpoints of one pair of vertices";
    }
  }

  void check_elements() {
    ASSERT_EQ(mesh_.triangle_of_element.size(), mesh_.elements.size());
    ASSERT_EQ(mesh_.part_of_element.size(), mesh_.elements.size());
    ASSERT_TRUE(std::ranges::is_sorted(mesh_.triangle_of_element));
    area_of_triangle_.assign(scene_.triangles.size(), 0.0);
    for (std::size_t e = 0; e < mesh_.elements.size(); ++e) {
      const std::uint32_t triangle = mesh_.triangle_of_element[e];
      const SubTriangle& part = mesh_.part_of_element[e];
      const glm::dvec2 u = glm::dvec2(part.corner[1]) - glm::dvec2(part.corner[0]);
      const glm::dvec2 v = glm::dvec2(part.corner[2]) - glm::dvec2(part.corner[0]);
      const double area = u.x * v.y - u.y * v.x;
      EXPECT_GT(area, 0.0) << "element " << e << " is turned over";
      area_of_triangle_[triangle] += area;
      for (int i = 0; i < 3; ++i) {
        check_edge(triangle, part.corner[i], part.corner[(i + 1) % 3]);
        const glm::vec3& at = mesh_.positions[mesh_.elements[e][i]];
        EXPECT_LT(glm::distance(at, point_at(scene_, triangle, part.corner[i])), 1e-6F + 1e-6F * glm::length(at));
        note_point(triangle, part.corner[i], at);
      }
    }
  }

  void check_edge(std::uint32_t triangle, const Barycentrics& from, const Barycentrics& to) {
    if (triangle_edge_of(from, to) == 3) {
      ++elements_at_inner_edge_[{triangle, at_of(from), at_of(to)}];
    }
  }

  void note_point(std::uint32_t triangle, const Barycentrics& at, const glm::vec3& position) {
    for (int edge = 0; edge < 3; ++edge) {
      if (triangle_edge_of(at, at) == edge || (edge == 1 && at.x + at.y == 1.0F) || (edge == 2 && at.x == 0.0F)) {
        points_on_edge_[{triangle, edge}].insert(point_of(position));
      }
    }
  }

  void check_shared_edges() const {
    std::map<std::pair<Point, Point>, std::set<Point>> points_between;
    for (const auto& [edge, points] : points_on_edge_) {
      const glm::uvec3& corners = scene_.triangles[edge.first];
      const std::pair<Point, Point> ends = std::minmax({point_of(scene_.positions[corners[edge.second]]),
                                                        point_of(scene_.positions[corners[(edge.second + 1) % 3]])});
      const auto [found, is_new] = points_between.try_emplace(ends, points);
      EXPECT_TRUE(is_new || found->second == points)
          << "edge " << edge.second << " of triangle " << edge.first << " is not cut as its copies are";
    }
  }

  const Scene& scene_;
  const RefinedMesh& mesh_;
  std::vector<double> area_of_triangle_;
  std::map<std::tuple<std::uint32_t, At, At>, int> elements_at_inner_edge_;
  std::map<std::pair<std::uint32_t, int>, std::set<Point>> points_on_edge_;
};

}  // namespace

Scene scene_of(std::vector<glm::vec3> positions, std::vector<glm::uvec3> triangles) {
  Scene scene;
  scene.positions = std::move(positions);
  scene.normals.assign(scene.positions.size(), glm::vec3(0.0F));
  scene.triangles = std::move(triangles);
  scene.surface_of_triangle.assign(scene.triangles.size(), 0);
  scene.surfaces = {Surface{}};
  return scene;
}

Scene fan(std::uint32_t count) {
  Scene scene = scene_of({{0, 0, 0}}, {});
  for (std::uint32_t i = 0; i < count; ++i) {
    const float angle = 6.2831853F * static_cast<float>(i) / static_cast<float>(count);
    scene.positions.emplace_back(std::cos(angle), std::sin(angle), 0.0F);
    scene.triangles.emplace_back(0, 1 + i, 1 + (i + 1) % count);
  }
  scene.normals.assign(scene.positions.size(), glm::vec3(0.0F));
  scene.surface_of_triangle.assign(count, 0);
  return scene;
}

std::size_t t_vertex_count(const RefinedMesh& mesh) {
  return find_t_vertices(mesh.positions, mesh.elements, rounding_tolerance(mesh.positions)).size();
}

void expect_conforming(const Scene& scene, const RefinedMesh& mesh) { Conformity(scene, mesh).check(); }

}  // namespace radiosity::test
