#include "core/reconstruct/smooth_groups.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "tests/core/test_meshes.h"

namespace radiosity {
namespace {

/// A vertex shared by two triangles, each with a copy of its own; their normals differ by an angle.
RefinedMesh two_copies(float degrees, bool with_normals) {
  RefinedMesh mesh;
  const float angle = glm::radians(degrees);
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {-std::cos(angle), 0, -std::sin(angle)}, {0, 1, 0}};
  mesh.elements = {{0, 1, 2}, {3, 5, 4}};
  const glm::vec3 other = glm::normalize(glm::cross(mesh.positions[5], mesh.positions[4]));
  mesh.normals.assign(6, glm::vec3(0.0F));
  if (with_normals) mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, other, other, other};
  return mesh;
}

TEST(SmoothGroups, JoinNormalsWithinFifteenDegrees) {
  for (const bool with_normals : {false, true}) {
    const SmoothGroups joined = find_smooth_groups(two_copies(10.0F, with_normals));
    EXPECT_EQ(joined.group_of_vertex[0], joined.group_of_vertex[3]);
    EXPECT_EQ(joined.group_of_vertex[2], joined.group_of_vertex[5]);
    EXPECT_EQ(joined.group_count, 4U);
    const SmoothGroups apart = find_smooth_groups(two_copies(20.0F, with_normals));
    EXPECT_NE(apart.group_of_vertex[0], apart.group_of_vertex[3]);
    EXPECT_EQ(apart.group_count, 6U);
  }
}

TEST(SmoothGroups, JoinNothingElsewhere) {
  const SmoothGroups groups = find_smooth_groups(test::grid(4));
  EXPECT_EQ(groups.group_count, 25U);
  EXPECT_EQ(find_smooth_groups({}).group_count, 0U);
}

TEST(SmoothGroups, AreNumberedByFirstAppearance) {
  const SmoothGroups groups = find_smooth_groups(two_copies(0.0F, true));
  EXPECT_EQ(groups.group_of_vertex, (std::vector<std::uint32_t>{0, 1, 2, 0, 3, 2}));
}

TEST(SpreadToUnknown, ContinuesRingByRingAndKeepsWhatIsKnown) {
  // Two squares apart from each other; in the first one end is known.
  RefinedMesh mesh;
  test::add_grid(mesh, 5, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const std::size_t first_of_other = mesh.positions.size();
  test::add_grid(mesh, 5, {5, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const SmoothGroups groups = find_smooth_groups(mesh);
  std::vector<std::uint8_t> known(groups.group_count, 0);
  std::vector<Rgb> value(groups.group_count, Rgb(0.0F));
  for (std::size_t v = 0; v < first_of_other; ++v) {
    if (mesh.positions[v].x > 0.1F) continue;
    known[groups.group_of_vertex[v]] = 1;
    value[groups.group_of_vertex[v]] = Rgb(mesh.positions[v].y < 0.5F ? 2.0F : 4.0F);
  }
  const std::vector<Rgb> before = value;
  spread_to_unknown(mesh, groups, known, value);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const std::uint32_t group = groups.group_of_vertex[v];
    EXPECT_EQ(known[group], v < first_of_other ? 1 : 0);
    if (v >= first_of_other || mesh.positions[v].x < 0.1F) {
      EXPECT_EQ(value[group], before[group]);
    } else {
      EXPECT_GE(value[group].x, 2.0F);
      EXPECT_LE(value[group].x, 4.0F);
    }
  }
}

TEST(SpreadToUnknown, LeavesAllAsItIsWhereNothingIsKnown) {
  const RefinedMesh mesh = test::grid(3);
  const SmoothGroups groups = find_smooth_groups(mesh);
  std::vector<std::uint8_t> known(groups.group_count, 0);
  std::vector<Rgb> value(groups.group_count, Rgb(0.0F));
  spread_to_unknown(mesh, groups, known, value);
  for (const std::uint8_t is_known : known) EXPECT_EQ(is_known, 0);
  for (const Rgb& light : value) EXPECT_EQ(light, Rgb(0.0F));
}

}  // namespace
}  // namespace radiosity
