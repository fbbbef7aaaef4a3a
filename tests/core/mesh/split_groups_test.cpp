#include "core/mesh/split_groups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <map>
#include <set>
#include <utility>

#include "core/mesh/patches.h"
#include "core/parallel.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

using Corners = std::array<glm::vec3, 3>;

Corners corners_of(const Scene& scene, const Tile& tile) {
  return {point_at(scene, tile.triangle, tile.part.corner[0]), point_at(scene, tile.triangle, tile.part.corner[1]),
          point_at(scene, tile.triangle, tile.part.corner[2])};
}

glm::vec3 middle_of(const Scene& scene, const Tile& tile) {
  return point_at(scene, tile.triangle, middle_of(tile.part));
}

bool every_side(const Tile& /*tile*/, bool /*back*/) { return true; }

/// A scene surveyed for patches of a given size.
struct Surveyed {
  explicit Surveyed(Scene scene_to_survey, float patch_size, std::size_t max_tiles = 1'000'000)
      : scene(std::move(scene_to_survey)),
        rays(scene),
        size(patch_size),
        tiling(make_tiles(scene, triangle_areas(scene), 0.5F * patch_size)),
        surveys(
            cut_straddling_tiles(rays, {.patch_size = patch_size, .max_tiles = max_tiles}, every_side, tiling, {})) {}

  Scene scene;
  RayScene rays;
  float size;
  Tiling tiling;
  Surveys surveys;
};

/// A look-out over the floor of `sunk_box` and its like, as high as those of tiles.
TileSide side_above(float x, float z, std::uint32_t group = 0) {
  return {.tile = 0, .back = false, .group = group, .lookout = {{x, 0.05F, z}, 0.05F, false}};
}

Parts split(const RayScene& rays, const std::vector<TileSide>& sides, std::uint32_t group_count = 1) {
  return split_groups(rays, {sides, group_count, 0.5F}, {});
}

/// A patch by the middles of its tiles, with their side.
using PatchesByPlace = std::set<std::set<std::array<int, 4>>>;

PatchesByPlace by_place(const Scene& scene, const Patches& patches) {
  std::map<std::uint32_t, std::set<std::array<int, 4>>> places;
  for (const Tile& tile : patches.tiling.leaves()) {
    const glm::ivec3 at(glm::round(middle_of(scene, tile) * 1e5F));
    if (const auto p = patches.patch_of_tile[tile.tile]; p != kNothing) places[p].insert({at.x, at.y, at.z, 0});
    if (const auto p = patches.back_patch_of_tile[tile.tile]; p != kNothing) places[p].insert({at.x, at.y, at.z, 1});
  }
  PatchesByPlace result;
  for (const auto& [patch, tiles] : places) result.insert(tiles);
  return result;
}

/// Patches by where the middles of their tiles lie. Tiles across the border do not count: one is not cut for ever.
struct Sorted {
  std::set<std::uint32_t> inside, outside;
};

template <typename IsInside>
Sorted sort_patches(const Scene& scene, const Patches& patches, std::uint32_t surface, const IsInside& is_inside) {
  Sorted sorted;
  for (const Tile& tile : patches.tiling.leaves()) {
    if (scene.surface_of_triangle[tile.triangle] != surface) continue;
    const Corners corners = corners_of(scene, tile);
    const bool inside = is_inside(middle_of(scene, tile));
    if (std::any_of(corners.begin(), corners.end(), [&](const glm::vec3& p) { return is_inside(p) != inside; }))
      continue;
    (inside ? sorted.inside : sorted.outside).insert(patches.patch_of_tile[tile.tile]);
  }
  return sorted;
}

void expect_apart(const Sorted& sorted) {
  EXPECT_FALSE(sorted.inside.empty());
  EXPECT_FALSE(sorted.outside.empty());
  for (const std::uint32_t patch : sorted.inside) EXPECT_FALSE(sorted.outside.contains(patch)) << patch;
}

TEST(CutStraddlingTiles, LeavesAnOpenFloorAlone) {
  const Surveyed s(test::floor_only(), 0.5F);
  EXPECT_EQ(s.tiling.leaves().size(), s.tiling.first_child.size());
  EXPECT_EQ(s.surveys.tiles.size(), s.tiling.first_child.size());
  ASSERT_EQ(s.surveys.sides.size(), s.surveys.tiles.size());
  for (const auto& [tile, back, group, lookout] : s.surveys.sides) {
    EXPECT_FALSE(lookout.covered);
    EXPECT_FLOAT_EQ(lookout.height, 0.05F);
    EXPECT_NEAR(lookout.lifted.y, 0.05F, 2e-4F);
  }
}

TEST(CutStraddlingTiles, DescribesEveryLeafOnce) {
  const Surveyed s(test::wall_through_floor(0.5F), 0.5F);
  std::set<std::uint32_t> surveyed, leaves;
  for (const Tile& tile : s.surveys.tiles) EXPECT_TRUE(surveyed.insert(tile.tile).second);
  for (const Tile& tile : s.tiling.leaves()) leaves.insert(tile.tile);
  EXPECT_EQ(surveyed, leaves);
}

TEST(CutStraddlingTiles, CutsToASixteenthOfAPatchUnderAWallAndNowhereElse) {
  const float size = 0.5F;
  const Surveyed s(test::wall_through_floor(0.5F), size);
  for (const Tile& tile : s.surveys.tiles) {
    if (tile.triangle >= 2) continue;
    const Corners corners = corners_of(s.scene, tile);
    const auto [low, high] = std::minmax({corners[0].x - 0.13F, corners[1].x - 0.13F, corners[2].x - 0.13F});
    const float length = longest_edge(s.scene, tile.triangle, tile.part);
    // A corner that is cut off by less than a twentieth of the way to the middle does not count.
    const bool under_the_wall = low < -0.1F * length && high > 0.1F * length;
    if (under_the_wall) {
      EXPECT_LT(length, size / 8.0F);
    } else if (low > size || high < -size) {
      EXPECT_GT(length, size / 4.0F);
    }
  }
}

TEST(CutStraddlingTiles, CutsForTheBackToo) {
  // The same floor with its front down and light on both sides.
  Scene scene = test::wall_through_floor(0.5F);
  for (std::size_t t = 0; t < 2; ++t) std::swap(scene.triangles[t].y, scene.triangles[t].z);
  for (std::size_t v = 0; v < 4; ++v) scene.normals[v] = -scene.normals[v];
  for (std::size_t v = 4; v < 8; ++v) scene.positions[v].y = std::max(scene.positions[v].y, 0.001F);
  const auto uncut = Surveyed(scene, 0.5F).surveys.tiles.size();
  scene.surfaces[0].two_sided = true;
  EXPECT_GT(Surveyed(scene, 0.5F).surveys.tiles.size(), uncut + 50);
}

TEST(CutStraddlingTiles, StopsCuttingWhereThereAreEnough) {
  const Scene scene = test::wall_through_floor(0.5F);
  const std::size_t uncut = make_tiles(scene, triangle_areas(scene), 0.25F).first_child.size();
  const std::size_t all = Surveyed(scene, 0.5F).surveys.tiles.size();
  ASSERT_GT(all, uncut + 100);
  EXPECT_EQ(Surveyed(scene, 0.5F, 0).surveys.tiles.size(), uncut);
  EXPECT_EQ(Surveyed(scene, 0.5F, uncut + 2).surveys.tiles.size(), uncut);
  EXPECT_EQ(Surveyed(scene, 0.5F, uncut + 30).surveys.tiles.size(), uncut + 30);
  EXPECT_TRUE(Surveyed(scene, 0.5F, uncut + 30).surveys.reached_limit);
  EXPECT_EQ(Surveyed(scene, 0.5F, all).surveys.tiles.size(), all);
  EXPECT_FALSE(Surveyed(scene, 0.5F, all).surveys.reached_limit);
}

TEST(CutStraddlingTiles, LeavesAsideWhatTakesNoPart) {
  const Scene scene = test::wall_through_floor(0.5F);
  const RayScene rays(scene);
  Tiling tiling = make_tiles(scene, triangle_areas(scene), 0.25F);
  const auto only_the_floor = [](const Tile& tile, bool /*back*/) { return tile.triangle < 2; };
  const Surveys surveys = cut_straddling_tiles(rays, {.patch_size = 0.5F}, only_the_floor, tiling, {});
  EXPECT_FALSE(surveys.sides.empty());
  EXPECT_FALSE(surveys.left_aside.empty());
  for (const TileSide& side : surveys.sides) EXPECT_LT(surveys.tiles[side.tile].triangle, 2U);
  for (const TileSide& side : surveys.left_aside) EXPECT_GE(surveys.tiles[side.tile].triangle, 2U);
}

TEST(CutStraddlingTiles, FindsWhatIsCovered) {
  const Surveyed s(test::panel_before_wall(0.001F), 0.2F);
  for (const TileSide& side : s.surveys.sides) {
    const Tile& tile = s.surveys.tiles[side.tile];
    if (tile.triangle >= 2) continue;
    const glm::vec3 at = glm::abs(middle_of(s.scene, tile));
    if (std::max(at.x, at.y) < 0.24F) {
      EXPECT_TRUE(side.lookout.covered);
      EXPECT_EQ(side.lookout.height, 0.0F);
    }
    if (std::max(at.x, at.y) > 0.26F) {
      EXPECT_FALSE(side.lookout.covered) << at.x << ' ' << at.y;
    }
  }
}

TEST(CutStraddlingTiles, StopsWhenCancelled) {
  const Scene scene = test::cornell_box();
  const RayScene rays(scene);
  Tiling tiling = make_tiles(scene, triangle_areas(scene), 0.1F);
  const Progress cancelled{.report = {}, .cancelled = [] { return true; }};
  EXPECT_THROW(cut_straddling_tiles(rays, {.patch_size = 0.2F}, every_side, tiling, cancelled), Cancelled);
}

TEST(SplitGroups, KeepsTogetherWhatSeesEachOther) {
  const Scene scene = test::wall_through_floor(0.5F);
  const RayScene rays(scene);
  const Parts parts = split(rays, {side_above(-0.3F, 0), side_above(0.0F, 0.2F), side_above(0.1F, -0.2F)});
  EXPECT_EQ(parts.count, 1U);
  EXPECT_EQ(parts.part_of_side, (std::vector<std::uint32_t>{0, 0, 0}));
}

TEST(SplitGroups, PartsWhatAWallStandsBetween) {
  const Scene scene = test::wall_through_floor(0.5F);
  const RayScene rays(scene);
  const Parts parts =
      split(rays, {side_above(0.2F, 0), side_above(0.0F, 0), side_above(0.3F, 0), side_above(0.1F, 0.2F)});
  EXPECT_EQ(parts.count, 2U);
  EXPECT_EQ(parts.part_of_side[0], parts.part_of_side[2]);
  EXPECT_EQ(parts.part_of_side[1], parts.part_of_side[3]);
  EXPECT_NE(parts.part_of_side[0], parts.part_of_side[1]);
}

TEST(SplitGroups, PartsTheCoveredFromTheOpen) {
  const Scene scene = test::floor_only();
  const RayScene rays(scene);
  std::vector<TileSide> sides{side_above(0, 0), side_above(0.1F, 0)};
  sides[1].lookout.covered = true;
  EXPECT_EQ(split(rays, sides).count, 2U);
}

TEST(SplitGroups, NeverJoinsGroups) {
  const Scene scene = test::floor_only();
  const RayScene rays(scene);
  const Parts parts = split(rays, {side_above(0, 0, 1), side_above(0, 0, 0), side_above(0.1F, 0, 1)}, 3);
  EXPECT_EQ(parts.count, 2U);
  EXPECT_EQ(parts.part_of_side, (std::vector<std::uint32_t>{1, 0, 1}));
}

TEST(SplitGroups, DoesNotDependOnTheOrderOfSides) {
  const Scene scene = test::wall_through_floor(0.5F);
  const RayScene rays(scene);
  std::vector<TileSide> sides;
  for (int k = 0; k < 40; ++k)
    sides.push_back(side_above(0.13F + 0.11F * std::sin(static_cast<float>(7 * k)), 0.01F * static_cast<float>(k)));
  const Parts forward = split(rays, sides);
  std::reverse(sides.begin(), sides.end());
  const Parts backward = split(rays, sides);
  EXPECT_EQ(forward.count, backward.count);
  for (std::size_t k = 0; k < sides.size(); ++k) {
    EXPECT_EQ(forward.part_of_side[k], backward.part_of_side[sides.size() - 1 - k]) << k;
  }
}

TEST(SplitGroups, MakesSixPartsAtMostInAThicket) {
  // Twelve compartments.
  Scene scene = test::floor_only();
  scene.surfaces.resize(1);
  for (int k = 0; k < 11; ++k) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    const float x = 0.1F * static_cast<float>(k) - 0.5F;
    for (const glm::vec3 p : {glm::vec3(x, 0, 2), {x, 0, -2}, {x, 1, -2}, {x, 1, 2}}) {
      scene.positions.push_back(p);
      scene.normals.emplace_back(1, 0, 0);
    }
    scene.triangles.emplace_back(first, first + 1, first + 2);
    scene.triangles.emplace_back(first, first + 2, first + 3);
    scene.surface_of_triangle.insert(scene.surface_of_triangle.end(), 2, 0U);
  }
  const RayScene rays(scene);
  std::vector<TileSide> sides;
  for (int k = 0; k < 12; ++k) sides.push_back(side_above(0.1F * static_cast<float>(k) - 0.55F, 0));
  const Parts parts = split(rays, sides);
  EXPECT_EQ(parts.count, 6U);
  for (std::size_t k = 6; k < 12; ++k) EXPECT_EQ(parts.part_of_side[k], 5U) << "the nearest of those there are";
}

TEST(SplitGroups, StopsWhenCancelled) {
  const Scene scene = test::floor_only();
  const RayScene rays(scene);
  const std::vector<TileSide> sides{side_above(0, 0)};
  const Progress cancelled{.report = {}, .cancelled = [] { return true; }};
  EXPECT_THROW(split_groups(rays, {sides, 1, 0.5F}, cancelled), Cancelled);
}

TEST(SplitPatches, LieOnOneSideOfAWall) {
  for (const float thickness : {0.1F, 0.01F, 0.002F}) {
    for (const float wall : {1.0F, 0.873F}) {
      const Scene scene = test::rooms_on_one_floor(wall, thickness);
      const RayScene rays(scene);
      for (const int max_patches : {200, 1000}) {
        const Patches patches = make_patches(rays, {.max_patches = max_patches}, {});
        for (std::uint32_t p = 0; p < patches.patch_count(); ++p) {
          bool left = false, right = false;
          for (const SurfacePoint& point : patches.points_of(p)) {
            left = left || point.position.x < wall;
            right = right || point.position.x > wall + thickness;
          }
          EXPECT_FALSE(left && right) << thickness << ", " << max_patches << ", patch " << p;
        }
        const auto is_left = [&](const glm::vec3& p) { return p.x < wall + 0.5F * thickness; };
        if (thickness < 0.005F) expect_apart(sort_patches(scene, patches, 0, is_left));
      }
    }
  }
}

TEST(SplitPatches, LieInsideOrOutsideABoxThatIsSunkIntoAFloor) {
  const Scene scene = test::sunk_box(0.5F);
  const RayScene rays(scene);
  const auto inside = [](const glm::vec3& p) { return p.x > -0.37F && p.x < 0.63F && p.z > -0.71F && p.z < 0.29F; };
  for (const int max_patches : {100, 500, 2000}) {
    const Patches patches = make_patches(rays, {.max_patches = max_patches}, {});
    const Sorted sorted = sort_patches(scene, patches, 0, inside);
    expect_apart(sorted);
    for (const std::uint32_t patch : sorted.inside) {
      for (const SurfacePoint& point : patches.points_of(patch)) EXPECT_TRUE(inside(point.position));
    }
    for (const std::uint32_t patch : sorted.outside) {
      for (const SurfacePoint& point : patches.points_of(patch)) EXPECT_FALSE(inside(point.position));
    }
  }
}

// Tiles are not cut at the panel's edge: over the gap they see along it.
TEST(SplitPatches, LieBehindOrBesideAPanel) {
  const Scene scene = test::panel_before_wall(0.001F);
  const RayScene rays(scene);
  const auto behind = [](const glm::vec3& p) { return std::max(std::abs(p.x), std::abs(p.y)) < 0.25F; };
  for (const int max_patches : {50, 300, 1000}) {
    const Patches patches = make_patches(rays, {.max_patches = max_patches}, {});
    expect_apart(sort_patches(scene, patches, 0, behind));
  }
}

TEST(SplitPatches, AreTheSameForPermutedTriangles) {
  const Scene scene = test::tessellated(test::wall_through_floor(0.5F), 6);
  Scene permuted = scene;
  std::reverse(permuted.triangles.begin(), permuted.triangles.end());
  std::reverse(permuted.surface_of_triangle.begin(), permuted.surface_of_triangle.end());
  std::rotate(permuted.triangles.begin(), permuted.triangles.begin() + 17, permuted.triangles.end());
  std::rotate(permuted.surface_of_triangle.begin(), permuted.surface_of_triangle.begin() + 17,
              permuted.surface_of_triangle.end());
  const RayScene rays(scene), permuted_rays(permuted);
  const PatchesByPlace a = by_place(scene, make_patches(rays, {.max_patches = 200}, {}));
  const PatchesByPlace b = by_place(permuted, make_patches(permuted_rays, {.max_patches = 200}, {}));
  EXPECT_EQ(a.size(), b.size());
  EXPECT_TRUE(a == b);
}

TEST(SplitPatches, AreTheSameForAnyNumberOfThreads) {
  const Scene scene = test::many_boxes(8, 2);
  const RayScene rays(scene);
  const auto make = [&] { return make_patches(rays, {.max_patches = 400}, {}); };
  const Patches one = on_threads(1, make), many = on_threads(5, make);
  EXPECT_EQ(one.tiling.first_child, many.tiling.first_child);
  EXPECT_EQ(one.patch_of_tile, many.patch_of_tile);
  EXPECT_EQ(one.area, many.area);
}

}  // namespace
}  // namespace radiosity
