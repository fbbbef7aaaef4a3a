#include "core/mesh/t_vertices.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/mesh/subdivide_uniform.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

/// The triangle above and, below its long edge, two whose common corner is `middle`.
std::vector<glm::vec3> long_edge_over(const glm::vec3& middle) {
  return {{0, 0, 0}, {4, 0, 0}, {2, 2, 0}, {0, 0, 0}, {4, 0, 0}, middle, {2, -2, 0}};
}
const std::vector<glm::uvec3> kOneOverTwo = {{0, 1, 2}, {3, 6, 5}, {5, 6, 4}};

TEST(TVertices, AreFoundInsideALongEdge) {
  const std::vector<glm::vec3> positions = long_edge_over({1, 0, 0});
  const std::vector<TVertex> found = find_t_vertices(positions, kOneOverTwo, 1e-6F);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].vertex, 5U);
  EXPECT_EQ(found[0].edge, glm::uvec2(0, 1));
  EXPECT_NEAR(found[0].at, 0.25F, 1e-6F);
}

TEST(TVertices, MayBeOffByRounding) {
  EXPECT_EQ(find_t_vertices(long_edge_over({1, 1e-6F, 0}), kOneOverTwo, 4e-6F).size(), 1U);
  EXPECT_EQ(find_t_vertices(long_edge_over({1, 1e-4F, 0}), kOneOverTwo, 4e-6F).size(), 0U) << "a gap, no T-vertex";
}

TEST(TVertices, AreNoneWhereBothSidesAreCut) {
  const std::vector<glm::vec3> positions = long_edge_over({1, 0, 0});
  EXPECT_TRUE(
      find_t_vertices(positions, std::vector<glm::uvec3>{{0, 5, 2}, {5, 1, 2}, {3, 6, 5}, {5, 6, 4}}, 1e-6F).empty());
  EXPECT_TRUE(find_t_vertices({}, {}, 1e-6F).empty());
}

TEST(TVertices, AreNotWhatTouchesAClosedEdge) {
  // A triangle stands with one corner on the diagonal of a square.
  const std::vector<glm::vec3> positions = {{0, 0, 0},       {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                            {0.5F, 0.5F, 0}, {0, 0, 1}, {1, 1, 1}};
  EXPECT_TRUE(find_t_vertices(positions, std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}, {4, 6, 5}}, 1e-6F).empty());
}

TEST(TVertices, AreFoundFarFromShortEdges) {
  // One edge of a kilometre along a thousand of a metre.
  std::vector<glm::vec3> positions = {{0, 0, 0}, {1000, 0, 0}, {500, 500, 0}, {500, -500, 0}};
  std::vector<glm::uvec3> triangles = {{0, 1, 2}};
  for (std::uint32_t i = 0; i <= 1000; ++i) positions.emplace_back(static_cast<float>(i), 0, 0);
  for (std::uint32_t i = 0; i < 1000; ++i) triangles.emplace_back(3, 5 + i, 4 + i);
  const std::vector<TVertex> found = find_t_vertices(positions, triangles, 1e-3F);
  ASSERT_EQ(found.size(), 999U);
  for (std::uint32_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].vertex, 5 + i) << "in order along the edge";
}

TEST(TVertices, AreNotInTheCornellBox) {
  const Scene scene = test::cornell_box();
  EXPECT_EQ(find_t_vertices(scene.positions, scene.triangles, rounding_tolerance(scene.positions)).size(), 0U);
}

}  // namespace
}  // namespace radiosity
