#include "plugin/split_creases.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

namespace gltf_radiosity {
namespace {

/// A fan of `count` squares around the z axis that turn by `degrees` at each edge.
void make_ribbon(int count, double degrees, std::vector<glm::vec3>& positions, std::vector<glm::uvec3>& triangles) {
  double x = 0, y = 0, angle = 0;
  for (int i = 0; i <= count; ++i) {
    positions.emplace_back(x, y, 0.0);
    positions.emplace_back(x, y, 1.0);
    x += std::cos(angle);
    y += std::sin(angle);
    angle += degrees * std::numbers::pi / 180;
  }
  for (unsigned i = 0; i < static_cast<unsigned>(count); ++i) {
    const unsigned a = 2 * i;
    triangles.emplace_back(a, a + 1, a + 2);
    triangles.emplace_back(a + 2, a + 1, a + 3);
  }
}

std::vector<std::uint32_t> split_ribbon(int count, double degrees) {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  make_ribbon(count, degrees, positions, triangles);
  return split_creases(positions, triangles);
}

TEST(SplitCreases, GentleTurnsStayWholeAndSharpOnesSplit) {
  EXPECT_TRUE(split_ribbon(5, 19.0).empty());
  EXPECT_EQ(split_ribbon(5, 21.0).size(), 12U + 4 * 2) << "two copies at each of the four inner edges";
}

TEST(SplitCreases, CopiesFollowTheOldVerticesAndKeepTheTrianglesInPlace) {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  make_ribbon(3, 90.0, positions, triangles);
  const std::vector<glm::uvec3> before = triangles;
  const std::vector<std::uint32_t> source = split_creases(positions, triangles);
  ASSERT_EQ(source.size(), 12U);
  for (std::uint32_t v = 0; v < positions.size(); ++v) EXPECT_EQ(source[v], v);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int corner = 0; corner < 3; ++corner) EXPECT_EQ(source[triangles[t][corner]], before[t][corner]);
  }
  for (std::size_t quad = 0; quad < 3; ++quad) {
    EXPECT_EQ(triangles[2 * quad].y, triangles[2 * quad + 1].y) << "the two triangles of a square stay together";
  }
}

TEST(SplitCreases, NeighboursAreFoundAcrossSeams) {
  // Two coplanar triangles with their own vertices meet a third at a right angle: only the latter's would be split, but
  // they are its own already.
  const std::vector<glm::vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  std::vector<glm::uvec3> triangles = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_TRUE(split_creases(positions, triangles).empty());
}

TEST(SplitCreases, FansThatTouchOnlyAtAPointPart) {
  const std::vector<glm::vec3> positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
  std::vector<glm::uvec3> triangles = {{0, 1, 2}, {0, 3, 4}};
  EXPECT_EQ(split_creases(positions, triangles).size(), 6U);
}

TEST(SplitCreases, OppositelyWoundTwinsPart) {
  const std::vector<glm::vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  std::vector<glm::uvec3> triangles = {{0, 1, 2}, {0, 2, 1}};
  EXPECT_EQ(split_creases(positions, triangles).size(), 6U);
}

TEST(SplitCreases, TrianglesWithoutAreaChangeNothing) {
  const std::vector<glm::vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
  std::vector<glm::uvec3> triangles = {{0, 1, 3}, {0, 1, 2}, {1, 1, 2}};
  EXPECT_TRUE(split_creases(positions, triangles).empty());
  EXPECT_EQ(triangles[0], glm::uvec3(0, 1, 3));
}

}  // namespace
}  // namespace gltf_radiosity
