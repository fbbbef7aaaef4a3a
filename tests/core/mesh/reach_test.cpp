#include "core/mesh/reach.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "core/parallel.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

/// The room of `rooms_on_one_floor` without light: what is left and right of the wall from x = 0.9 to 1.
Scene two_rooms() {
  Scene scene = test::rooms_on_one_floor(0.9F, 0.1F);
  scene.lights.clear();
  return scene;
}

/// A scene's patches; which of them are reached is asked for again, of all of them.
struct Reached {
  explicit Reached(Scene scene_to_reach)
      : scene(std::move(scene_to_reach)),
        rays(scene),
        patches(make_patches(rays, {.max_patches = 300}, {})),
        reached(find_reached(rays, patches, patches.patch_count(), {})) {}

  bool at(const SurfacePoint& point) const {
    const auto patch =
        static_cast<std::size_t>(&point - patches.points.data()) / static_cast<std::size_t>(patches.points_per_patch);
    return reached[patch] != 0;
  }

  Scene scene;
  RayScene rays;
  Patches patches;
  std::vector<std::uint8_t> reached;
};

bool all(const std::vector<std::uint8_t>& flags) {
  return std::all_of(flags.begin(), flags.end(), [](std::uint8_t flag) { return flag == 1; });
}

TEST(FindReached, ReachesWhatSeesTheOpen) {
  EXPECT_TRUE(all(Reached(test::floor_only()).reached));
  EXPECT_TRUE(all(Reached(test::cornell_box()).reached));
}

TEST(FindReached, ReachesAllWhereNothingIsReached) {
  const Reached room(test::box_room({2, 1, 1}, {}));
  EXPECT_TRUE(all(room.reached));
  EXPECT_EQ(room.patches.unreached, kNothing);
}

TEST(FindReached, ReachesTheRoomOfALightAndNoOther) {
  Scene scene = two_rooms();
  scene.lights = {{.kind = Light::Kind::kPoint, .position = {0.1F, 0.1F, 0.1F}}};
  const Reached rooms(scene);
  ASSERT_NE(rooms.patches.unreached, kNothing);
  for (const SurfacePoint& point : rooms.patches.points) {
    // The wall stands on some tiles, which are reached if a part of them is.
    if (point.position.x > 0.8F && point.position.x < 1.1F) continue;
    EXPECT_EQ(rooms.at(point), point.position.x < 0.9F) << point.position.x;
  }
}

TEST(FindReached, ReachesTheRoomOfALampAsSmallAsAFlame) {
  Scene scene = two_rooms();
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  for (const glm::vec3 p : {glm::vec3(0.4F, 0.5F, 0.5F), {0.401F, 0.5F, 0.5F}, {0.4F, 0.501F, 0.5F}}) {
    scene.positions.push_back(p);
    scene.normals.emplace_back(0.0F, 0.0F, 1.0F);
  }
  scene.triangles.emplace_back(first, first + 1, first + 2);
  scene.surface_of_triangle.push_back(static_cast<std::uint32_t>(scene.surfaces.size()));
  scene.surfaces.push_back({.emission = Rgb(1000.0F), .two_sided = true});
  const Reached rooms(scene);
  for (const SurfacePoint& point : rooms.patches.points) {
    if (point.position.x > 0.8F && point.position.x < 1.1F) continue;
    EXPECT_EQ(rooms.at(point), point.position.x < 0.9F) << point.position.x;
  }
}

TEST(FindReached, ReachesARoomThroughASmallWindow) {
  // The ceiling of the right room is 1 m2; a hole of a hundredth of it is left open.
  Scene scene = test::tessellated(test::box_room({1, 1, 1}, {}), 10);
  scene.triangles.erase(scene.triangles.begin() + 2 * 300 + 155, scene.triangles.begin() + 2 * 300 + 157);
  scene.surface_of_triangle.resize(scene.triangles.size());
  EXPECT_TRUE(all(Reached(scene).reached));
}

TEST(FindReached, LeavesPatchesAloneThatItIsNotAskedAbout) {
  // The last patch is what is known to be dark; walks through the tiles under the wall lead there too.
  Scene scene = two_rooms();
  scene.lights = {{.kind = Light::Kind::kPoint, .position = {0.1F, 0.1F, 0.1F}}};
  const Reached rooms(scene);
  ASSERT_EQ(rooms.patches.unreached, rooms.patches.patch_count() - 1);
  const auto reached = find_reached(rooms.rays, rooms.patches, rooms.patches.unreached, {});
  EXPECT_EQ(reached.size(), rooms.patches.unreached);
  EXPECT_TRUE(std::equal(reached.begin(), reached.end(), rooms.reached.begin()));
}

TEST(FindReached, IsTheSameForAnyNumberOfThreads) {
  Scene scene = two_rooms();
  scene.lights = {{.kind = Light::Kind::kPoint, .position = {0.1F, 0.1F, 0.1F}}};
  const Reached rooms(scene);
  const auto find = [&] { return find_reached(rooms.rays, rooms.patches, rooms.patches.patch_count(), {}); };
  for (const int threads : {1, 2, 7}) EXPECT_EQ(on_threads(threads, find), rooms.reached);
}

TEST(FindReached, StopsWhenCancelled) {
  const Reached room(test::cornell_box());
  const Progress cancelled{.report = {}, .cancelled = [] { return true; }};
  EXPECT_THROW(find_reached(room.rays, room.patches, room.patches.patch_count(), cancelled), Cancelled);
}

}  // namespace
}  // namespace radiosity
