#include "core/verify/camera.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

TEST(Camera, LooksWhereItIsPointed) {
  const Camera camera = make_camera({{0.0F, 1.0F, 5.0F}, {0.0F, 1.0F, 0.0F}}, 90.0F, 2.0F);
  const glm::vec3 middle = camera.ray(0.0F, 0.0F).direction;
  EXPECT_NEAR(glm::distance(middle, glm::vec3(0.0F, 0.0F, -1.0F)), 0.0F, 1e-6F);
  // The top edge is 45 degrees up, the right edge twice as far from the middle.
  const glm::vec3 top = camera.ray(0.0F, 1.0F).direction, right = camera.ray(1.0F, 0.0F).direction;
  EXPECT_NEAR(top.y / -top.z, 1.0F, 1e-5F);
  EXPECT_NEAR(right.x / -right.z, 2.0F, 1e-5F);
}

TEST(Camera, LooksStraightDownToo) {
  const Ray ray = make_camera({{0.0F, 5.0F, 0.0F}, {0.0F, 0.0F, 0.0F}}, 50.0F, 1.0F).ray(0.0F, 0.0F);
  EXPECT_NEAR(ray.direction.y, -1.0F, 1e-6F);
}

TEST(Camera, SeesThroughTheBacksOfARoom) {
  const Scene scene = test::white_furnace(0.5F, 1.0F);
  const RayScene rays(scene);
  const View view = default_view(rays);
  EXPECT_GT(view.eye.y, 1.0F) << "from outside";
  const Ray ray = make_camera(view, 50.0F, 1.0F).ray(0.0F, 0.0F);
  const auto hit = nearest_seen(rays, ray, surface_offset(scene), [] { return 0.5F; });
  ASSERT_TRUE(hit);
  EXPECT_FALSE(hit->back);
  EXPECT_NEAR(glm::distance(point_at(scene, hit->triangle, hit->at), ray.from), hit->distance, 1e-3F);
}

TEST(Camera, StandsInsideARoomWhoseWallsHideIt) {
  Surface wall;
  wall.two_sided = true;
  const Scene scene = test::box_room(glm::vec3(1.0F), wall);
  const RayScene rays(scene);
  const glm::vec3 eye = default_view(rays).eye;
  EXPECT_TRUE(eye.x > 0.0F && eye.x < 1.0F && eye.y > 0.0F && eye.y < 1.0F && eye.z > 0.0F && eye.z < 1.0F);
}

}  // namespace
}  // namespace radiosity
