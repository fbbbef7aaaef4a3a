#include "core/mesh/stitch.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "core/mesh/subdivide_adaptive.h"
#include "core/mesh/subdivide_uniform.h"
#include "tests/core/mesh/conformity.h"
#include "tests/core/test_meshes.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

using test::scene_of;
using test::t_vertex_count;

constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();

/// A triangle above its long edge and, below, a fan whose corners on that edge are at a fifth and at a half, on
/// vertices of its own. The corners are `off` the edge.
Scene one_over_three(float off = 0.0F) {
  return scene_of({{0, 0, 0}, {10, 0, 0}, {5, 5, 0}, {0, 0, 0}, {2, off, 0}, {5, -off, 0}, {10, 0, 0}, {5, -5, 0}},
                  {{0, 1, 2}, {7, 4, 3}, {7, 5, 4}, {7, 6, 5}});
}

TEST(Stitch, CutsALongEdgeWhereItsNeighboursHaveVertices) {
  CutMesh cut(one_over_three());
  EXPECT_EQ(stitch(cut, kAny), 2U);
  EXPECT_EQ(t_vertex_count(cut.mesh), 0U);
  EXPECT_EQ(cut.mesh.elements.size(), 6U);
  ASSERT_EQ(cut.mesh.cuts.size(), 2U);
  EXPECT_EQ(cut.mesh.positions[8], glm::vec3(2, 0, 0));
  EXPECT_EQ(cut.mesh.positions[9], glm::vec3(5, 0, 0));

  // Attributes go by the distance along the edge.
  std::vector<Rgb> along;
  for (int v = 0; v < 8; ++v) along.emplace_back(Rgb(cut.mesh.positions[static_cast<std::size_t>(v)].x));
  append_cuts(cut.mesh, along);
  EXPECT_NEAR(along[8].x, 2.0F, 1e-5F);
  EXPECT_NEAR(along[9].x, 5.0F, 1e-5F);
  double area = 0.0;
  for (std::size_t e = 0; e < cut.mesh.elements.size(); ++e) {
    if (cut.mesh.triangle_of_element[e] == 0) area += test::area_of(cut.mesh.part_of_element[e]);
  }
  EXPECT_NEAR(area, 0.5, 1e-6) << "the parts cover the triangle";
}

TEST(Stitch, TakesTheVertexsPlaceWhereItIsOffByRounding) {
  CutMesh cut(one_over_three(5e-6F));
  EXPECT_EQ(stitch(cut, kAny), 2U);
  EXPECT_EQ(cut.mesh.positions[8], cut.mesh.positions[4]);
  EXPECT_EQ(cut.mesh.positions[9], cut.mesh.positions[5]);
}

TEST(Stitch, LeavesGapsAndSoundScenesAlone) {
  CutMesh gap(one_over_three(0.01F));
  EXPECT_EQ(stitch(gap, kAny), 0U);
  CutMesh sound(test::cornell_box());
  EXPECT_EQ(stitch(sound, kAny), 0U);
  CutMesh limited(one_over_three());
  EXPECT_EQ(stitch(limited, 1), 0U);
  EXPECT_EQ(limited.mesh.positions.size(), 8U);
}

TEST(Stitch, LetsRefinementConformAcrossWhatWasACrack) {
  CutMesh cut(one_over_three(5e-6F));
  stitch(cut, kAny);
  EdgeCopies edges(cut);
  Bisector bisector(cut, edges, {});
  for (int round = 0; round < 6; ++round) {
    std::vector<std::uint32_t> upper;
    for (std::uint32_t e = 0; e < cut.mesh.elements.size(); ++e) {
      if (cut.mesh.triangle_of_element[e] == 0) upper.push_back(e);
    }
    bisector.bisect(upper);
  }
  EXPECT_GT(cut.mesh.elements.size(), 100U);
  EXPECT_EQ(t_vertex_count(cut.mesh), 0U);
  EXPECT_EQ(t_vertex_count(subdivide_uniform(one_over_three(), {.patch_size = 0.7F, .level_of_triangle = {}}, {}).mesh),
            0U);
}

}  // namespace
}  // namespace radiosity
