#include "core/visibility/single_ray.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <vector>

#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

constexpr auto kHalf = [] { return 0.5F; };

TEST(SingleRay, MeetsTheNearestTriangleAndKnowsItsSide) {
  const Scene scene = test::occluder();
  const RayScene rays(scene);
  const auto plate = nearest_hit(rays, {{0.1F, 0.2F, 0.1F}, {0.0F, 1.0F, 0.0F}}, kHalf);
  ASSERT_TRUE(plate);
  EXPECT_EQ(scene.surface_of_triangle[plate->triangle], 1U);
  EXPECT_NEAR(plate->distance, 0.8F, 1e-5F);
  EXPECT_TRUE(plate->back);
  EXPECT_NEAR(glm::distance(point_at(scene, plate->triangle, plate->at), glm::vec3(0.1F, 1.0F, 0.1F)), 0.0F, 1e-5F);
  const auto floor = nearest_hit(rays, {{0.1F, 0.2F, 0.1F}, {0.0F, -1.0F, 0.0F}}, kHalf);
  ASSERT_TRUE(floor);
  EXPECT_FALSE(floor->back);
}

TEST(SingleRay, EndsWhereItIsTold) {
  const Scene scene = test::occluder();
  const RayScene rays(scene);
  const glm::vec3 from(0.0F, 0.2F, 0.0F), up(0.0F, 1.0F, 0.0F);
  EXPECT_TRUE(is_blocked(rays, {from, up, 0.81F}, kHalf));
  EXPECT_FALSE(is_blocked(rays, {from, up, 0.79F}, kHalf));
  EXPECT_FALSE(nearest_hit(rays, {from, up, 0.79F}, kHalf));
  EXPECT_FALSE(nearest_hit(rays, {{0.0F, 3.0F, 0.0F}, up}, kHalf));
}

TEST(SingleRay, SeesThroughTheGapsOfAFence) {
  const test::DetailedScene fence = test::see_through_fence();
  const RayScene rays(fence.scene);
  const glm::vec3 up(0.0F, 1.0F, 0.0F);
  EXPECT_TRUE(is_blocked(rays, {{0.05F, 0.5F, 0.1F}, up, 1.0F}, kHalf));
  EXPECT_FALSE(is_blocked(rays, {{0.20F, 0.5F, 0.1F}, up, 1.0F}, kHalf));
  const auto lamp = nearest_hit(rays, {{0.20F, 0.5F, 0.1F}, up}, kHalf);
  ASSERT_TRUE(lamp);
  EXPECT_EQ(fence.scene.surface_of_triangle[lamp->triangle], 2U);
}

TEST(SingleRay, TrianglesNearAPlaceIncludeThoseThatCoincide) {
  Scene scene = test::parallel_squares(1.0F);
  scene.triangles.push_back(scene.triangles[0]);
  scene.surface_of_triangle.push_back(1);
  const RayScene rays(scene);
  const std::vector<std::uint32_t> near = triangles_near(rays, {0.75F, 0.25F, 0.001F}, 0.01F);
  EXPECT_TRUE(near == (std::vector<std::uint32_t>{0, 4}) || near == (std::vector<std::uint32_t>{0, 1, 4}));
  EXPECT_TRUE(triangles_near(rays, {0.5F, 0.5F, 0.5F}, 0.1F).empty());
}

}  // namespace
}  // namespace radiosity
