#include "core/verify/places.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

constexpr auto kAnyTriangle = [](std::uint32_t) { return 0; };

TEST(Places, AreSpreadByArea) {
  // The floor is 16 m2, the plate 1 m2, the lamp 0.25 m2.
  const Scene scene = test::occluder();
  const std::vector<SurfacePlace> places = random_places(scene, std::vector<std::uint8_t>(6, 1), 1725, 1);
  ASSERT_EQ(places.size(), 1725U);
  std::vector<int> count(3, 0);
  for (const SurfacePlace& place : places) {
    ++count[place.triangle / 2];
    EXPECT_TRUE(place.at.x >= 0.0F && place.at.y >= 0.0F && place.at.x + place.at.y <= 1.0F + 1e-6F);
  }
  EXPECT_NEAR(count[0], 1600, 1);
  EXPECT_NEAR(count[1], 100, 1);
  EXPECT_NEAR(count[2], 25, 1);
}

TEST(Places, LieOnlyWhereTheyAreWanted) {
  const Scene scene = test::occluder();
  for (const SurfacePlace& place : random_places(scene, std::vector<std::uint8_t>{0, 0, 0, 1, 0, 0}, 50, 1)) {
    EXPECT_EQ(place.triangle, 3U);
  }
  EXPECT_TRUE(random_places(scene, std::vector<std::uint8_t>(6, 0), 50, 1).empty());
}

TEST(Places, AreFoundAgainInTheSameScene) {
  const Scene scene = test::cornell_box();
  const RayScene rays(scene);
  const PlaceFinder finder(rays);
  const std::vector<std::uint8_t> all(scene.triangles.size(), 1);
  for (const SurfacePlace& place : random_places(scene, all, 300, 5)) {
    const glm::vec3 position = point_at(scene, place.triangle, place.at);
    const auto found = finder.find(position, glm::normalize(scaled_normal(scene, place.triangle)), kAnyTriangle);
    ASSERT_TRUE(found);
    EXPECT_LT(glm::distance(point_at(scene, found->triangle, found->at), position), 2.0F * surface_offset(scene));
  }
}

TEST(Places, OfTwoSheetsTheOneThatFacesTheSameWayIsFound) {
  // Both lie in z = 0, back to back.
  Scene scene = test::parallel_squares(0.0F);
  const RayScene rays(scene);
  const PlaceFinder finder(rays);
  const glm::vec3 position(0.4F, 0.3F, 0.0F);
  const auto front = finder.find(position, {0.0F, 0.0F, 1.0F}, kAnyTriangle);
  const auto back = finder.find(position, {0.0F, 0.0F, -1.0F}, kAnyTriangle);
  ASSERT_TRUE(front && back);
  EXPECT_EQ(scene.surface_of_triangle[front->triangle], 0U);
  EXPECT_EQ(scene.surface_of_triangle[back->triangle], 1U);
  EXPECT_FALSE(finder.find(position, {1.0F, 0.0F, 0.0F}, kAnyTriangle));
}

TEST(Places, OfCoincidentSheetsThePreferredOneIsFound) {
  Scene scene = test::parallel_squares(1.0F);
  scene.triangles.insert(scene.triangles.end(), {scene.triangles[0], scene.triangles[1]});
  scene.surface_of_triangle.insert(scene.surface_of_triangle.end(), {1, 1});
  const RayScene rays(scene);
  const PlaceFinder finder(rays);
  for (const std::uint32_t wanted : {0U, 1U}) {
    const auto preference = [&](std::uint32_t t) { return scene.surface_of_triangle[t] == wanted ? 1 : 0; };
    const auto found = finder.find({0.4F, 0.3F, 0.0F}, {0.0F, 0.0F, 1.0F}, preference);
    ASSERT_TRUE(found);
    EXPECT_EQ(scene.surface_of_triangle[found->triangle], wanted);
  }
  EXPECT_FALSE(finder.find({0.4F, 0.3F, 0.0F}, {0.0F, 0.0F, 1.0F}, [](std::uint32_t) { return -1; }));
}

TEST(Places, NothingIsFoundFarFromEverything) {
  const Scene scene = test::occluder();
  const RayScene rays(scene);
  EXPECT_FALSE(PlaceFinder(rays).find({0.0F, 0.5F, 0.0F}, {0.0F, 1.0F, 0.0F}, kAnyTriangle));
}

}  // namespace
}  // namespace radiosity
