#include "core/reconstruct/interpolate_vertices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "tests/core/test_meshes.h"

namespace radiosity {
namespace {

using test::add_grid;
using test::grid;
using test::middle;

/// Elements lit by a function of their middle, all known.
ElementLight light_of(const RefinedMesh& mesh, const std::function<Rgb(const glm::vec3&)>& field) {
  ElementLight light;
  for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) light.irradiance.push_back(field(middle(mesh, e)));
  light.unknown.assign(mesh.elements.size(), 0);
  return light;
}

bool inside(const glm::vec3& p) { return p.x > 0.01F && p.x < 0.99F && p.y > 0.01F && p.y < 0.99F; }

TEST(InterpolateVertices, ReproducesConstantLight) {
  RefinedMesh mesh;
  add_grid(mesh, 5, {100, -3, 7}, {0.3F, 0.1F, 0}, {0, 0.2F, 0.9F});
  const Rgb constant(0.1F, 20.0F, 3e5F);
  const std::vector<Rgb> result =
      interpolate_vertices(mesh, light_of(mesh, [&](const glm::vec3&) { return constant; }));
  ASSERT_EQ(result.size(), mesh.positions.size());
  for (const Rgb& value : result) {
    for (int band = 0; band < 3; ++band) EXPECT_FLOAT_EQ(value[band], constant[band]);
  }
}

TEST(InterpolateVertices, ReproducesALinearFieldInsideAndNearlyAtTheBorder) {
  const RefinedMesh mesh = grid(8);
  const auto field = [](const glm::vec3& p) { return Rgb(2.0F + p.x, 5.0F - 3.0F * p.y, 1.0F + p.x + p.y); };
  const std::vector<Rgb> result = interpolate_vertices(mesh, light_of(mesh, field));
  for (std::size_t v = 0; v < result.size(); ++v) {
    const Rgb expected = field(mesh.positions[v]);
    // The border is extrapolated to, and the damping loses a part of the step of at most 3/8: half in the corners.
    const float tolerance = inside(mesh.positions[v]) ? 1e-5F : 3.0F / 8.0F * 0.55F;
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(result[v][band], expected[band], tolerance) << v;
  }
}

TEST(InterpolateVertices, IsNeverNegative) {
  const RefinedMesh mesh = grid(6);
  const auto field = [](const glm::vec3& p) { return Rgb(p.x < 0.3F ? 0.0F : 100.0F * (p.x - 0.3F)); };
  for (const Rgb& value : interpolate_vertices(mesh, light_of(mesh, field))) EXPECT_GE(value.x, 0.0F);
}

TEST(InterpolateVertices, StaysNearTheRangeOfItsElements) {
  const RefinedMesh mesh = grid(6);
  const auto field = [](const glm::vec3& p) { return Rgb(p.x + p.y > 1.0F ? 10.0F : 5.0F); };
  for (const Rgb& value : interpolate_vertices(mesh, light_of(mesh, field))) {
    EXPECT_GE(value.x, 2.5F);
    EXPECT_LE(value.x, 12.5F);
  }
}

TEST(InterpolateVertices, KeepsTheSidesOfACreaseApart) {
  // A floor and a wall that meet in the x axis, each with vertices of its own.
  RefinedMesh mesh;
  add_grid(mesh, 4, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const std::size_t first_of_wall = mesh.positions.size();
  add_grid(mesh, 4, {0, 0, 0}, {0, 0, 1}, {1, 0, 0});
  const auto field = [](const glm::vec3& p) { return Rgb(p.z > 0.0F ? 5.0F : 1.0F); };
  const std::vector<Rgb> result = interpolate_vertices(mesh, light_of(mesh, field));
  for (std::size_t v = 0; v < result.size(); ++v) EXPECT_FLOAT_EQ(result[v].x, v < first_of_wall ? 1.0F : 5.0F);
}

TEST(InterpolateVertices, JoinsTheSidesOfASeam) {
  // Two halves of a plane with separate vertices where they meet, lit like one.
  RefinedMesh mesh;
  add_grid(mesh, 4, {-1, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const std::size_t first_of_right = mesh.positions.size();
  add_grid(mesh, 4, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const auto field = [](const glm::vec3& p) { return Rgb(p.x > 0.0F ? 5.0F : 1.0F); };
  const std::vector<Rgb> result = interpolate_vertices(mesh, light_of(mesh, field));
  int seen = 0;
  for (std::size_t a = 0; a < first_of_right; ++a) {
    for (std::size_t b = first_of_right; b < result.size(); ++b) {
      if (mesh.positions[a] != mesh.positions[b]) continue;
      EXPECT_EQ(result[a], result[b]);
      const bool at_end = mesh.positions[a].y < 0.01F || mesh.positions[a].y > 0.99F;
      EXPECT_NEAR(result[a].x, 3.0F, at_end ? 1.5F : 0.6F);
      ++seen;
    }
  }
  EXPECT_EQ(seen, 5);
}

TEST(InterpolateVertices, DoesNotCountBuriedElements) {
  const RefinedMesh mesh = grid(6);
  ElementLight light = light_of(mesh, [](const glm::vec3&) { return Rgb(7.0F); });
  for (std::size_t e = 0; e < light.unknown.size(); e += 3) {
    light.unknown[e] = 1;
    light.irradiance[e] = Rgb(0.0F);
  }
  for (const Rgb& value : interpolate_vertices(mesh, light)) EXPECT_FLOAT_EQ(value.x, 7.0F);
}

TEST(InterpolateVertices, FillsBuriedVerticesFromTheirNeighbours) {
  const RefinedMesh mesh = grid(10);
  ElementLight light = light_of(mesh, [](const glm::vec3&) { return Rgb(7.0F); });
  for (std::uint32_t e = 0; e < light.unknown.size(); ++e) {
    if (middle(mesh, e).x < 0.5F) continue;
    light.unknown[e] = 1;
    light.irradiance[e] = Rgb(0.0F);
  }
  for (const Rgb& value : interpolate_vertices(mesh, light)) EXPECT_FLOAT_EQ(value.x, 7.0F);
}

TEST(InterpolateVertices, LeavesDarkWhatNoLightIsKnownOf) {
  const RefinedMesh mesh = grid(3);
  ElementLight light = light_of(mesh, [](const glm::vec3&) { return Rgb(7.0F); });
  light.unknown.assign(light.unknown.size(), 1);
  for (const Rgb& value : interpolate_vertices(mesh, light)) EXPECT_EQ(value, Rgb(0.0F));
}

TEST(InterpolateVertices, AcceptsAnEmptyMesh) { EXPECT_TRUE(interpolate_vertices({}, {}).empty()); }

}  // namespace
}  // namespace radiosity
