#include "core/mesh/collapse_net.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/mesh/weld.h"
#include "tests/core/mesh/conformity.h"

namespace radiosity {
namespace {

using testing::UnorderedElementsAre;

CollapseNet net_of(const Scene& scene) {
  const Weld welded = weld(scene.positions);
  return {scene.triangles, welded.class_of_vertex, welded.class_count};
}

std::vector<std::uint32_t> neighbours(const CollapseNet& net, std::uint32_t vertex) {
  std::vector<CollapseNet::Spoke> spokes;
  net.find_spokes(vertex, spokes);
  std::vector<std::uint32_t> ends;
  for (const CollapseNet::Spoke& spoke : spokes) ends.push_back(spoke.to);
  return ends;
}

TEST(CollapseNet, FindsSpokesClockwise) {
  const CollapseNet net = net_of(test::fan(4));
  std::vector<CollapseNet::Spoke> spokes;
  net.find_spokes(0, spokes);
  ASSERT_EQ(spokes.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(spokes[i].element + 1, spokes[i].to) << "triangle i lies left of the spoke to vertex i + 1";
    EXPECT_EQ(spokes[(i + 1) % 4].to, (spokes[i].to + 2) % 4 + 1);
    EXPECT_EQ(net.edge_between(0, spokes[i].to), spokes[i].edge);
  }
  net.find_spokes(1, spokes);
  EXPECT_EQ(spokes.size(), 3U);
  EXPECT_EQ(spokes[0].element, kNothing) << "beyond the border";
}

TEST(CollapseNet, MovesAVertexOntoItsNeighbour) {
  CollapseNet net = net_of(test::fan(5));
  EXPECT_TRUE(net.collapse(0, 1));
  EXPECT_THAT(neighbours(net, 1), UnorderedElementsAre(2, 3, 4, 5));
  EXPECT_THAT(neighbours(net, 3), UnorderedElementsAre(1, 2, 4));
}

TEST(CollapseNet, RefusesWhatWouldFoldTheSurface) {
  CollapseNet net = net_of(
      test::scene_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}));
  for (std::uint32_t to = 1; to < 4; ++to) EXPECT_FALSE(net.collapse(0, to)) << "a tetrahedron has no less";
  EXPECT_EQ(neighbours(net, 0).size(), 3U);
}

TEST(CollapseNet, HoldsWhatOpenMeshDoesNotSee) {
  // A third triangle at the edge from 0 to 1, and another that names a position twice.
  const CollapseNet net = net_of(test::scene_of(
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {2, 2, 0}, {2, 2, 0}, {3, 2, 0}, {9, 9, 9}},
      {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {5, 6, 7}}));
  for (const std::uint32_t vertex : {0U, 1U, 4U, 5U, 6U, 7U}) EXPECT_TRUE(net.is_fixed(vertex)) << vertex;
  for (const std::uint32_t vertex : {2U, 3U}) EXPECT_FALSE(net.is_fixed(vertex)) << vertex;
}

TEST(CollapseNet, HoldsAPointWhereFansMeet) {
  const CollapseNet net =
      net_of(test::scene_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}));
  EXPECT_TRUE(net.is_fixed(0));
  EXPECT_FALSE(net.is_fixed(1));
}

}  // namespace
}  // namespace radiosity
