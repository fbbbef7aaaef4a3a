#include "core/mesh/subdivide_uniform.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/mesh/weld.h"
#include "tests/core/mesh/conformity.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

using testing::Each;
using testing::ElementsAre;

using test::expect_conforming;
using test::scene_of;
using test::t_vertex_count;

Subdivision cut_to_size(const Scene& scene, float patch_size) {
  return subdivide_uniform(scene, {.patch_size = patch_size, .level_of_triangle = {}}, {});
}

Subdivision cut_to_levels(const Scene& scene, const std::vector<std::int8_t>& levels, float patch_size = 0.0F) {
  return subdivide_uniform(scene, {.patch_size = patch_size, .level_of_triangle = levels}, {});
}

std::vector<std::size_t> elements_per_triangle(const Scene& scene, const RefinedMesh& mesh) {
  std::vector<std::size_t> count(scene.triangles.size(), 0);
  for (const std::uint32_t triangle : mesh.triangle_of_element) {
    ++count[triangle];
  }
  return count;
}

float longest_edge(const RefinedMesh& mesh) {
  float longest = 0.0F;
  for (const glm::uvec3& element : mesh.elements) {
    for (int i = 0; i < 3; ++i) {
      longest = std::max(longest, glm::distance(mesh.positions[element[i]], mesh.positions[element[(i + 1) % 3]]));
    }
  }
  return longest;
}

const std::vector<glm::vec3> kSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

TEST(SubdivideUniform, LeavesASceneAloneThatNobodyAsksToCut) {
  const Scene scene = test::cornell_box();
  for (const Subdivision& result : {cut_to_size(scene, 0.0F), cut_to_size(scene, 10.0F),
                                    cut_to_levels(scene, std::vector<std::int8_t>(scene.triangles.size(), 0), 0.01F)}) {
    EXPECT_EQ(result.mesh.elements, scene.triangles);
    EXPECT_TRUE(result.mesh.cuts.empty());
    EXPECT_FALSE(result.reached_limit);
    expect_conforming(scene, result.mesh);
  }
}

TEST(SubdivideUniform, KeepsAreaAndOrientation) {
  const Scene scene = test::cornell_box();
  const RefinedMesh mesh = cut_to_size(scene, 0.05F).mesh;
  std::vector<double> area(scene.triangles.size(), 0.0);
  for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) {
    const std::uint32_t triangle = mesh.triangle_of_element[e];
    const glm::uvec3& corners = mesh.elements[e];
    const glm::vec3& a = mesh.positions[corners.x];
    const glm::vec3 normal = glm::cross(mesh.positions[corners.y] - a, mesh.positions[corners.z] - a);
    const glm::vec3 whole = scaled_normal(scene, triangle);
    EXPECT_GT(glm::dot(normal, whole), 0.999F * glm::length(normal) * glm::length(whole));
    area[triangle] += static_cast<double>(element_area(mesh, e));
  }
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    EXPECT_NEAR(area[t], 0.5 * static_cast<double>(glm::length(scaled_normal(scene, t))), 1e-7);
  }
}

TEST(SubdivideUniform, LeavesNoEdgeLongerThanThePatchSize) {
  for (const float patch_size : {0.3F, 0.1F, 0.033F}) {
    const Scene scene = test::cornell_box();
    const RefinedMesh mesh = cut_to_size(scene, patch_size).mesh;
    EXPECT_LE(longest_edge(mesh), patch_size * 1.000001F);
    expect_conforming(scene, mesh);
  }
}

TEST(SubdivideUniform, MakesNoTVertexInTheTestScenes) {
  EXPECT_EQ(t_vertex_count(cut_to_size(test::cornell_box(), 0.15F).mesh), 0U);
  EXPECT_EQ(t_vertex_count(cut_to_size(test::box_room({1, 2, 3}, Surface{}), 0.4F).mesh), 0U);
  EXPECT_EQ(t_vertex_count(cut_to_size(test::unit_cube_faces(), 0.2F).mesh), 0U);
}

TEST(SubdivideUniform, ALevelCutsIntoFourThatManyTimes) {
  const Scene scene = test::box_room({1, 1, 1}, Surface{});
  for (std::int8_t level = 0; level <= 5; ++level) {
    const RefinedMesh mesh = cut_to_levels(scene, std::vector<std::int8_t>(12, level)).mesh;
    EXPECT_THAT(elements_per_triangle(scene, mesh), Each(std::size_t{1} << (2 * level)));
    expect_conforming(scene, mesh);
  }
}

TEST(SubdivideUniform, ALevelGivesSimilarTriangles) {
  const Scene scene = scene_of({{0, 0, 0}, {3, 0, 0}, {1, 2, 0}}, {{0, 1, 2}});
  const RefinedMesh mesh = cut_to_levels(scene, {3}).mesh;
  for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) {
    EXPECT_NEAR(element_area(mesh, e), 3.0F / 64.0F, 1e-6F);
  }
  EXPECT_NEAR(longest_edge(mesh), 3.0F / 8.0F, 1e-6F);
}

TEST(SubdivideUniform, NeighboursOfATriangleWithALevelConform) {
  const Scene scene = scene_of(kSquare, {{0, 1, 2}, {0, 2, 3}});
  const RefinedMesh mesh = cut_to_levels(scene, {3, 0}).mesh;
  EXPECT_THAT(elements_per_triangle(scene, mesh), ElementsAre(64, 8));
  expect_conforming(scene, mesh);
  EXPECT_EQ(t_vertex_count(mesh), 0U);
}

TEST(SubdivideUniform, ALevelStandsEvenIfThePatchSizeAsksForMore) {
  const Scene scene =
      scene_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}}, {{0, 1, 2}, {3, 4, 5}});
  const RefinedMesh mesh = cut_to_levels(scene, {1, kLevelFromPatchSize}, 0.1F).mesh;
  EXPECT_EQ(elements_per_triangle(scene, mesh)[0], 4U);
  EXPECT_GT(elements_per_triangle(scene, mesh)[1], 100U);
}

TEST(SubdivideUniform, TwoHalvedEdgesGiveThreeElementsAlongTheShorterDiagonal) {
  // Edges 3 and 3.16 long, and one of 1: the first two are halved.
  const Scene scene = scene_of({{0, 0, 0}, {3, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  const RefinedMesh mesh = cut_to_size(scene, 2.0F).mesh;
  ASSERT_EQ(mesh.elements.size(), 3U);
  expect_conforming(scene, mesh);

  // From corner 2 to the middle of edge 01: 1.80; from corner 0 to the middle of edge 12: 1.58.
  const auto has_edge = [&](const glm::vec3& a, const glm::vec3& b) {
    return std::ranges::any_of(mesh.elements, [&](const glm::uvec3& element) {
      const auto is_corner = [&](const glm::vec3& p) {
        return p == mesh.positions[element.x] || p == mesh.positions[element.y] || p == mesh.positions[element.z];
      };
      return is_corner(a) && is_corner(b);
    });
  };
  EXPECT_TRUE(has_edge({0, 0, 0}, {1.5F, 0.5F, 0}));
  EXPECT_FALSE(has_edge({0, 1, 0}, {1.5F, 0, 0}));
}

TEST(SubdivideUniform, OneHalvedEdgeGivesTwoElements) {
  const Scene scene = scene_of({{0, 0, 0}, {2, 0, 0}, {1, 1, 0}}, {{0, 1, 2}});
  const RefinedMesh mesh = cut_to_size(scene, 1.5F).mesh;
  EXPECT_EQ(mesh.elements.size(), 2U);
  expect_conforming(scene, mesh);
}

TEST(SubdivideUniform, ASeamStaysASeam) {
  // Two triangles with vertices of their own along the diagonal.
  const Scene scene =
      scene_of({kSquare[0], kSquare[1], kSquare[2], kSquare[0], kSquare[2], kSquare[3]}, {{0, 1, 2}, {3, 4, 5}});
  const RefinedMesh mesh = cut_to_levels(scene, {2, 2}).mesh;
  expect_conforming(scene, mesh);
  EXPECT_EQ(mesh.positions.size(), 2U * 15U);
  EXPECT_EQ(weld(mesh.positions).class_count, 25U);
  std::vector<int> side_of_vertex = {0, 0, 0, 1, 1, 1};
  for (const auto& [ends, at] : mesh.cuts) {
    EXPECT_EQ(side_of_vertex[ends.x], side_of_vertex[ends.y]) << "a midpoint reaches across the seam";
    side_of_vertex.push_back(side_of_vertex[ends.x]);
  }
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(side_of_vertex[mesh.elements[e][i]], static_cast<int>(mesh.triangle_of_element[e]));
    }
  }
}

TEST(SubdivideUniform, AnEdgeWithoutASeamGetsOneMidpoint) {
  const Scene scene = scene_of(kSquare, {{0, 1, 2}, {0, 2, 3}});
  EXPECT_EQ(cut_to_levels(scene, {2, 2}).mesh.positions.size(), 25U);
}

TEST(SubdivideUniform, AThirdTriangleAtAnEdgeSharesItsMidpoint) {
  Scene scene = scene_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  const RefinedMesh mesh = cut_to_levels(scene, {1, 0, 0}).mesh;
  EXPECT_THAT(elements_per_triangle(scene, mesh), ElementsAre(4, 2, 2));
  EXPECT_EQ(mesh.cuts.size(), 3U);
  expect_conforming(scene, mesh);
}

TEST(SubdivideUniform, DuplicatedTrianglesSurvive) {
  const Scene scene = scene_of(kSquare, {{0, 1, 2}, {0, 1, 2}, {1, 2, 0}, {0, 2, 3}});
  const RefinedMesh mesh = cut_to_levels(scene, {2, 2, 2, 2}).mesh;
  EXPECT_THAT(elements_per_triangle(scene, mesh), ElementsAre(16, 16, 16, 16));
  EXPECT_EQ(mesh.positions.size(), 25U) << "copies of an edge between the same vertices share its midpoint";
  expect_conforming(scene, mesh);
}

TEST(SubdivideUniform, OppositelyWoundTrianglesSurvive) {
  const Scene scene = scene_of(kSquare, {{0, 1, 2}, {0, 3, 2}, {2, 1, 0}});
  const RefinedMesh mesh = cut_to_levels(scene, {2, 2, 2}).mesh;
  EXPECT_THAT(elements_per_triangle(scene, mesh), ElementsAre(16, 16, 16));
  expect_conforming(scene, mesh);
}

TEST(SubdivideUniform, TrianglesBackToBackAreCutAlike) {
  const Scene scene = scene_of({{0, 0, 0}, {3, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 0}});
  const RefinedMesh mesh = cut_to_size(scene, 0.3F).mesh;
  const std::vector<std::size_t> count = elements_per_triangle(scene, mesh);
  EXPECT_EQ(count[0], count[1]);
  expect_conforming(scene, mesh);
  EXPECT_EQ(t_vertex_count(mesh), 0U);
}

TEST(SubdivideUniform, AFanOfAnySizeConforms) {
  // More triangles at one vertex than are joined there.
  constexpr std::uint32_t kCount = 600;
  const Scene scene = test::fan(kCount);
  const RefinedMesh mesh = cut_to_levels(scene, std::vector<std::int8_t>(kCount, 1)).mesh;
  EXPECT_EQ(mesh.elements.size(), 4U * kCount);
  EXPECT_EQ(mesh.cuts.size(), 2U * kCount) << "one for each edge";
  expect_conforming(scene, mesh);
}

TEST(SubdivideUniform, DegenerateTrianglesSurvive) {
  // Repeated vertices, repeated positions, three points on a line; beside a sound triangle.
  const Scene scene = scene_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {2, 0, 0}},
                               {{0, 1, 2}, {0, 0, 1}, {0, 3, 1}, {1, 1, 1}, {0, 1, 4}});
  const RefinedMesh mesh = cut_to_levels(scene, {2, 0, 0, 0, 0}).mesh;
  // The edge from 0 to 1 is cut in four: a triangle on it twice over becomes nine, once over four.
  EXPECT_THAT(elements_per_triangle(scene, mesh), ElementsAre(16, 9, 9, 1, 4));
  expect_conforming(scene, mesh);
}

TEST(SubdivideUniform, DegenerateTrianglesMayBeAskedToo) {
  const Scene scene = scene_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}, {0, 0, 0}, {0, 1, 0}});
  const RefinedMesh mesh = cut_to_levels(scene, {2, 5, 1}).mesh;
  EXPECT_EQ(elements_per_triangle(scene, mesh)[0], 16U);
  EXPECT_EQ(elements_per_triangle(scene, mesh)[1], 1U) << "there is nothing to halve in a point";
  expect_conforming(scene, mesh);
}

TEST(SubdivideUniform, EndsAtEdgesTooShortToHaveAMiddle) {
  const float next = std::nextafter(1.0F, 2.0F);
  const Scene scene = scene_of({{1, 1, 1}, {next, 1, 1}, {1, next, 1}}, {{0, 1, 2}});
  // Only the longest edge, from one neighbour of a number to another, has a middle that is neither end.
  EXPECT_LE(cut_to_levels(scene, {6}).mesh.elements.size(), 2U);
  EXPECT_FALSE(cut_to_size(scene, 1e-20F).reached_limit);
}

TEST(SubdivideUniform, HalvesOfALongEdgeJoinTheShortEdgesAlongIt) {
  // The scene has a T-vertex at (1,0,0): the long edge is cut there first, then both halves in four twice.
  const Scene scene =
      scene_of({{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 0, 0}, {1, -1, 0}}, {{0, 1, 2}, {0, 4, 3}, {3, 4, 1}});
  const RefinedMesh mesh = cut_to_levels(scene, {2, 0, 0}).mesh;
  EXPECT_THAT(elements_per_triangle(scene, mesh), ElementsAre(32, 4, 4));
  EXPECT_EQ(t_vertex_count(mesh), 0U);
}

TEST(SubdivideUniform, EndsBeforeARoundThatWouldExceedTheLimit) {
  const Scene scene = test::box_room({1, 1, 1}, Surface{});
  const std::vector<std::int8_t> levels(12, 5);
  const Subdivision result = subdivide_uniform(scene, {.level_of_triangle = levels, .max_elements = 773}, {});
  EXPECT_TRUE(result.reached_limit);
  EXPECT_EQ(result.mesh.elements.size(), 12U * 64U);
  expect_conforming(scene, result.mesh);
  EXPECT_FALSE(subdivide_uniform(scene, {.level_of_triangle = levels, .max_elements = 12'288}, {}).reached_limit);
}

TEST(SubdivideUniform, ShadingNormalsStayUnitOrZero) {
  Scene scene = scene_of(kSquare, {{0, 1, 2}, {0, 2, 3}});
  scene.normals = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 0}};
  const RefinedMesh mesh = cut_to_levels(scene, {3, 3}).mesh;
  for (const glm::vec3& normal : mesh.normals) {
    const float length = glm::length(normal);
    EXPECT_TRUE(length == 0.0F || std::abs(length - 1.0F) < 1e-6F) << length;
  }
  const RefinedMesh once = cut_to_levels(scene, {1, 0}).mesh;
  for (std::size_t k = 0; k < once.cuts.size(); ++k) {
    if (once.cuts[k].ends == glm::uvec2(0, 1)) {
      EXPECT_LT(glm::distance(once.normals[4 + k], glm::normalize(glm::vec3(1, 1, 0))), 1e-6F);
    }
  }
}

TEST(SubdivideUniform, VerticesOfNoTriangleStay) {
  Scene scene = scene_of({{0, 0, 0}, {9, 9, 9}, {1, 0, 0}, {0, 1, 0}}, {{0, 2, 3}});
  const RefinedMesh mesh = cut_to_levels(scene, {1}).mesh;
  EXPECT_EQ(mesh.positions[1], glm::vec3(9, 9, 9));
  EXPECT_EQ(mesh.positions.size(), 7U);
}

TEST(SubdivideUniform, AcceptsASceneWithoutTriangles) { EXPECT_TRUE(cut_to_size(Scene{}, 0.1F).mesh.elements.empty()); }

TEST(SubdivideUniform, GivesTheSameBytesTwice) {
  const Scene scene = test::many_boxes(30, 7);
  const RefinedMesh a = cut_to_size(scene, 0.3F).mesh;
  const RefinedMesh b = cut_to_size(scene, 0.3F).mesh;
  EXPECT_EQ(a.elements, b.elements);
  EXPECT_EQ(a.cuts, b.cuts);
  ASSERT_EQ(a.positions.size(), b.positions.size());
  EXPECT_EQ(std::memcmp(a.positions.data(), b.positions.data(), a.positions.size() * sizeof(glm::vec3)), 0);
}

TEST(SubdivideUniform, ReportsProgressThatOnlyRises) {
  std::vector<double> reports;
  const Progress progress{.report =
                              [&](std::string_view phase, double done) {
                                EXPECT_EQ(phase, "subdivide");
                                reports.push_back(done);
                              },
                          .cancelled = {}};
  subdivide_uniform(test::cornell_box(), {.patch_size = 0.01F, .level_of_triangle = {}}, progress);
  EXPECT_TRUE(std::ranges::is_sorted(reports));
  EXPECT_GT(reports.size(), 10U);
  EXPECT_EQ(reports.back(), 1.0);
}

TEST(SubdivideUniform, EndsWhenCancelled) {
  int asked = 0;
  const Progress progress{.report = {}, .cancelled = [&] { return ++asked > 5; }};
  EXPECT_THROW(subdivide_uniform(test::cornell_box(), {.patch_size = 0.001F, .level_of_triangle = {}}, progress),
               Cancelled);
}

TEST(SubdivideUniform, AnySoupOfTrianglesConforms) {
  // Few points on a lattice: every fault there is, many times over; all coordinates of the first rounds are exact.
  std::mt19937 generator(1);
  const auto random = [&](std::uint32_t below) { return static_cast<std::uint32_t>(generator() % below); };
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<glm::vec3> positions(4 + random(20));
    for (glm::vec3& position : positions) {
      position = {static_cast<float>(random(3)), static_cast<float>(random(3)), static_cast<float>(random(2))};
    }
    const auto count = static_cast<std::uint32_t>(positions.size());
    std::vector<glm::uvec3> triangles(1 + random(40));
    std::vector<std::int8_t> levels(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      triangles[t] = {random(count), random(count), random(count)};
      levels[t] = static_cast<std::int8_t>(static_cast<int>(random(4)) - 1);
    }
    const Scene scene = scene_of(positions, triangles);
    const RefinedMesh mesh = cut_to_levels(scene, levels, 0.4F).mesh;
    expect_conforming(scene, mesh);

    const std::vector<std::size_t> elements = elements_per_triangle(scene, mesh);
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      const bool is_degenerate = scaled_normal(scene, t) == glm::vec3(0.0F);
      EXPECT_GE(elements[t], is_degenerate ? 1U : std::size_t{1} << (2 * std::max<int>(levels[t], 0)));
    }
    ASSERT_FALSE(testing::Test::HasFailure()) << "trial " << trial;
  }
}

TEST(DefaultPatchSize, GivesAboutFourThousandSquaresOnTheSurface) {
  EXPECT_NEAR(default_patch_size(test::box_room({1, 1, 1}, Surface{})), std::sqrt(6.0F / 4000.0F), 1e-6F);
  EXPECT_EQ(default_patch_size(Scene{}), 0.0F);
}

}  // namespace
}  // namespace radiosity
