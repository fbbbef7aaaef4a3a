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

TEST(SmoothGroups, AreNumberedByFirstAppearance) {
  const SmoothGroups groups = find_smooth_groups(two_copies(0.0F, true));
  EXPECT_EQ(groups.group_of_vertex, (std::vector<std::uint32_t>{0, 1, 2, 0, 3, 2}));
}

}  // namespace
}  // namespace radiosity
