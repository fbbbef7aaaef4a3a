#include "plugin/assemble_triangles.h"

#include <gtest/gtest.h>

namespace gltf_radiosity {
namespace {

using Triangles = std::vector<glm::uvec3>;
const std::vector<std::uint32_t> kOrder = {5, 6, 7, 8, 9};

TEST(AssembleTriangles, AListTakesThreeAtATimeAndLeavesTheRest) {
  EXPECT_EQ(assemble_triangles(kOrder, kTriangleList), (Triangles{{5, 6, 7}}));
}

TEST(AssembleTriangles, AStripTurnsEverySecondTriangle) {
  EXPECT_EQ(assemble_triangles(kOrder, kTriangleStrip), (Triangles{{5, 6, 7}, {6, 8, 7}, {7, 8, 9}}));
}

TEST(AssembleTriangles, AFanTurnsAboutItsFirstVertex) {
  EXPECT_EQ(assemble_triangles(kOrder, kTriangleFan), (Triangles{{6, 7, 5}, {7, 8, 5}, {8, 9, 5}}));
}

TEST(AssembleTriangles, TwoVerticesAreNoTriangle) {
  const std::vector<std::uint32_t> two = {0, 1};
  for (const int mode : {kTriangleList, kTriangleStrip, kTriangleFan})
    EXPECT_TRUE(assemble_triangles(two, mode).empty());
}

}  // namespace
}  // namespace gltf_radiosity
