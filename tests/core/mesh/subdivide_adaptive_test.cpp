#include "core/mesh/subdivide_adaptive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <map>
#include <string>
#include <vector>

#include "core/mesh/subdivide_uniform.h"
#include "core/mesh/weld.h"
#include "tests/core/mesh/conformity.h"
#include "tests/core/test_meshes.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

using test::expect_conforming;
using test::fan;
using test::middle;
using test::scene_of;
using test::t_vertex_count;

const std::vector<glm::vec3> kCorners = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

/// Scenes of all kinds.
std::map<std::string, Scene> sound_and_faulty() {
  return {{"closed", test::box_room({1, 2, 3}, Surface{})},
          {"cornell box", test::cornell_box()},
          {"seam", scene_of({kCorners[0], kCorners[1], kCorners[2], kCorners[0], kCorners[2], kCorners[3]},
                            {{0, 1, 2}, {3, 4, 5}})},
          {"third triangle at an edge",
           scene_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}})},
          {"duplicates", scene_of(kCorners, {{0, 1, 2}, {0, 1, 2}, {1, 2, 0}, {0, 2, 3}})},
          {"wound both ways", scene_of(kCorners, {{0, 1, 2}, {0, 3, 2}, {2, 1, 0}})},
          {"fan", fan(600)},
          {"degenerate", scene_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {2, 0, 0}},
                                  {{0, 1, 2}, {0, 0, 1}, {0, 3, 1}, {1, 1, 1}, {0, 1, 4}})},
          {"slivers", scene_of({{0, 0, 0}, {1, 0, 0}, {0.5F, 1e-3F, 0}, {0.5F, -1.0F, 0}}, {{0, 1, 2}, {1, 0, 3}})}};
}

/// The elements whose middle is near a place.
std::vector<std::uint32_t> near(const RefinedMesh& mesh, const glm::vec3& place, float radius) {
  std::vector<std::uint32_t> elements;
  for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) {
    if (glm::distance(middle(mesh, e), place) < radius) elements.push_back(e);
  }
  return elements;
}

/// Cuts round after round, closer and closer to a corner of the scene.
void cut_towards_a_corner(CutMesh& cut, Bisector& bisector, int rounds) {
  float radius = 4.0F;
  for (int round = 0; round < rounds; ++round, radius *= 0.75F) {
    bisector.bisect(near(cut.mesh, cut.mesh.positions[1], radius));
  }
}

TEST(SubdivideAdaptive, ConformsWhateverTheScene) {
  for (const auto& [name, scene] : sound_and_faulty()) {
    SCOPED_TRACE(name);
    CutMesh cut(scene);
    EdgeCopies edges(cut);
    Bisector bisector(cut, edges, {});
    cut_towards_a_corner(cut, bisector, 10);
    group_by_triangle(cut.mesh, scene.triangles.size());
    EXPECT_GT(cut.mesh.elements.size(), scene.triangles.size());
    expect_conforming(scene, cut.mesh);
    EXPECT_EQ(t_vertex_count(cut.mesh), 0U);
  }
}

TEST(SubdivideAdaptive, CutsWhereItIsAsked) {
  const Scene scene = test::floor_only();
  CutMesh cut(scene);
  EdgeCopies edges(cut);
  Bisector bisector(cut, edges, {});
  cut_towards_a_corner(cut, bisector, 12);
  const glm::vec3 corner = scene.positions[1];
  const auto smallest_near = [&](const glm::vec3& place) {
    float area = 16.0F;
    for (const std::uint32_t e : near(cut.mesh, place, 0.7F)) area = std::min(area, element_area(cut.mesh, e));
    return area;
  };
  EXPECT_LT(smallest_near(corner), 0.01F);
  EXPECT_GT(smallest_near(-0.85F * corner), 0.4F);
}

TEST(SubdivideAdaptive, KeepsShapes) {
  // Half squares stay half squares; the smallest angle of others is not halved more than once.
  for (const auto& [scene, least] :
       {std::pair(test::floor_only(), 0.7F), {scene_of({{0, 0, 0}, {3, 0, 0}, {1, 2, 0}}, {{0, 1, 2}}), 0.3F}}) {
    CutMesh cut(scene);
    EdgeCopies edges(cut);
    Bisector bisector(cut, edges, {});
    cut_towards_a_corner(cut, bisector, 14);
    for (const glm::uvec3& element : cut.mesh.elements) {
      for (int k = 0; k < 3; ++k) {
        const glm::vec3 u = cut.mesh.positions[element[(k + 1) % 3]] - cut.mesh.positions[element[k]];
        const glm::vec3 v = cut.mesh.positions[element[(k + 2) % 3]] - cut.mesh.positions[element[k]];
        EXPECT_GT(std::acos(glm::dot(u, v) / (glm::length(u) * glm::length(v))), least);
      }
    }
  }
}

TEST(SubdivideAdaptive, SaysWhereEveryElementComesFrom) {
  const Scene scene = test::box_room({1, 2, 3}, Surface{});
  CutMesh cut(scene);
  EdgeCopies edges(cut);
  Bisector bisector(cut, edges, {});
  cut_towards_a_corner(cut, bisector, 4);
  const RefinedMesh before = cut.mesh;
  const std::vector<std::uint32_t> origin = bisector.bisect(near(cut.mesh, {0, 0, 0}, 1.5F));
  ASSERT_EQ(origin.size(), cut.mesh.elements.size());
  std::vector<double> area(before.elements.size(), 0.0);
  for (std::uint32_t e = 0; e < origin.size(); ++e) {
    ASSERT_LT(origin[e], before.elements.size());
    EXPECT_EQ(cut.mesh.triangle_of_element[e], before.triangle_of_element[origin[e]]);
    area[origin[e]] += test::area_of(cut.mesh.part_of_element[e]);
  }
  for (std::uint32_t e = 0; e < area.size(); ++e) EXPECT_EQ(area[e], test::area_of(before.part_of_element[e])) << e;
}

TEST(SubdivideAdaptive, NeverExceedsTheVerticesAllowed) {
  const Scene scene = test::box_room({1, 1, 1}, Surface{});
  for (const std::size_t most : {0U, 24U, 25U, 100U, 333U}) {
    CutMesh cut(scene);
    EdgeCopies edges(cut);
    Bisector bisector(cut, edges, {.mesh = {.max_vertices = most}, .level_of_triangle = {}});
    for (int round = 0; round < 12; ++round) bisector.bisect(near(cut.mesh, {0, 0, 0}, 9.0F));
    EXPECT_LE(cut.mesh.positions.size(), std::max<std::size_t>(most, 24U));
    EXPECT_GE(cut.mesh.positions.size() + 3, most) << "a cut takes four vertices at most, two on either side of a seam";
    EXPECT_TRUE(bisector.reached_limit());
    EXPECT_EQ(t_vertex_count(cut.mesh), 0U);
  }
}

TEST(SubdivideAdaptive, NeverExceedsTheElementsAllowed) {
  CutMesh cut(test::box_room({1, 1, 1}, Surface{}));
  EdgeCopies edges(cut);
  Bisector bisector(cut, edges, {.mesh = {.max_elements = 100}, .level_of_triangle = {}});
  cut_towards_a_corner(cut, bisector, 12);
  EXPECT_LE(cut.mesh.elements.size(), 100U);
  EXPECT_GT(cut.mesh.elements.size(), 90U);
  EXPECT_TRUE(bisector.reached_limit());
}

TEST(SubdivideAdaptive, LeavesShortEdgesAndTrianglesWithALevelAlone) {
  const Scene scene =
      scene_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}}, {{0, 1, 2}, {3, 4, 5}});
  const std::vector<std::int8_t> levels = {0, kLevelFromPatchSize};
  CutMesh cut(scene);
  EdgeCopies edges(cut);
  Bisector bisector(cut, edges, {.mesh = {}, .min_edge = 0.25F, .level_of_triangle = levels});
  for (int round = 0; round < 20; ++round) bisector.bisect(near(cut.mesh, {0, 0, 0}, 100.0F));
  EXPECT_EQ(std::ranges::count(cut.mesh.triangle_of_element, 0U), 1);
  EXPECT_EQ(std::ranges::count(cut.mesh.triangle_of_element, 1U), 32) << "edges of 0.25 and 0.18";
  EXPECT_FALSE(bisector.reached_limit());
}

TEST(SubdivideAdaptive, StartsWithNoEdgeLongerThanAsked) {
  const Scene scene = test::cornell_box();
  CutMesh cut(scene);
  EdgeCopies edges(cut);
  Bisector bisector(cut, edges, {});
  bisector.bisect_longer_than(0.2);
  for (std::uint32_t e = 0; e < cut.mesh.elements.size(); ++e) EXPECT_LE(bisector.longest_edge(e), 0.2);
  EXPECT_EQ(t_vertex_count(cut.mesh), 0U);
}

TEST(SubdivideAdaptive, EndsAtEdgesTooShortToHaveAMiddle) {
  const float next = std::nextafter(1.0F, 2.0F);
  CutMesh cut(scene_of({{1, 1, 1}, {next, 1, 1}, {1, next, 1}}, {{0, 1, 2}}));
  EdgeCopies edges(cut);
  Bisector bisector(cut, edges, {});
  bisector.bisect_longer_than(0.0);
  EXPECT_LE(cut.mesh.elements.size(), 2U);
}

TEST(SubdivideAdaptive, GivesTheSameBytesTwice) {
  const auto refined = [] {
    CutMesh cut(test::many_boxes(30, 7));
    EdgeCopies edges(cut);
    Bisector bisector(cut, edges, {});
    cut_towards_a_corner(cut, bisector, 6);
    return cut.mesh;
  };
  const RefinedMesh a = refined(), b = refined();
  EXPECT_EQ(a.elements, b.elements);
  EXPECT_EQ(a.cuts, b.cuts);
  ASSERT_EQ(a.positions.size(), b.positions.size());
  EXPECT_EQ(std::memcmp(a.positions.data(), b.positions.data(), a.positions.size() * sizeof(glm::vec3)), 0);
}

}  // namespace
}  // namespace radiosity
