#include "core/mesh/tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "tests/core/test_meshes.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

using test::area_of;
using test::holds;

/// Points all over a triangle, the same ones each time.
std::vector<Barycentrics> many_points() {
  std::mt19937 generator(1);
  const auto random = [&] { return static_cast<float>(generator() >> 8U) * 0x1p-24F; };
  std::vector<Barycentrics> points;
  for (int k = 0; k < 2000; ++k) {
    const Barycentrics at(random(), random());
    points.push_back(at.x + at.y > 1.0F ? 1.0F - at : at);
  }
  return points;
}

/// Two squares in tiles, and every third tile cut in four, five times over: some of the new ones too.
Tiling unevenly_cut(const Scene& scene) {
  Tiling tiling = make_tiles(scene, triangle_areas(scene), 0.6F);
  for (int round = 0; round < 5; ++round) {
    const std::vector<Tile> leaves = tiling.leaves();
    for (std::size_t k = 0; k < leaves.size(); k += 3) {
      tiling.first_child[leaves[k].tile] = static_cast<std::uint32_t>(tiling.first_child.size());
      tiling.first_child.resize(tiling.first_child.size() + 4, kNothing);
    }
  }
  return tiling;
}

void expect_near(const SubTriangle& a, const SubTriangle& b) {
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(a.corner[k].x, b.corner[k].x, 1e-6F);
    EXPECT_NEAR(a.corner[k].y, b.corner[k].y, 1e-6F);
  }
}

TEST(Tiles, CoverTheTriangleInCongruentParts) {
  for (std::uint32_t n = 1; n <= 9; ++n) {
    double area = 0.0;
    for (std::uint32_t tile = 0; tile < n * n; ++tile) {
      EXPECT_NEAR(area_of(tile_part(n, tile)), 0.5 / (n * n), 1e-7) << n << ", " << tile;
      EXPECT_TRUE(holds({}, middle_of(tile_part(n, tile))));
      area += area_of(tile_part(n, tile));
    }
    EXPECT_NEAR(area, 0.5, 1e-6) << n;
  }
}

TEST(Tiles, AreFoundFromTheirMiddle) {
  for (std::uint32_t n = 1; n <= 9; ++n) {
    for (std::uint32_t tile = 0; tile < n * n; ++tile)
      EXPECT_EQ(locate(n, middle_of(tile_part(n, tile))).tile, tile) << n;
  }
}

TEST(Tiles, HoldThePointsTheyAreFoundFrom) {
  for (std::uint32_t n = 1; n <= 9; ++n) {
    for (const Barycentrics at : many_points()) {
      const PlaceInTile place = locate(n, at);
      const SubTriangle part = tile_part(n, place.tile);
      EXPECT_TRUE(holds(part, at)) << n << ": " << at.x << ", " << at.y;
      // And they lie where they are said to lie in it.
      const Barycentrics again = compose(part, {{place.at, place.at, place.at}}).corner[0];
      EXPECT_NEAR(again.x, at.x, 1e-6F);
      EXPECT_NEAR(again.y, at.y, 1e-6F);
    }
  }
}

TEST(Tiles, AreFoundAtCornersAndALittleOutside) {
  for (std::uint32_t n = 1; n <= 9; ++n) {
    for (const Barycentrics at : {Barycentrics(0, 0),
                                  {1, 0},
                                  {0, 1},
                                  {0.5F, 0.5F},
                                  {1.0001F, 0.0001F},
                                  {-1e-5F, 0.5F},
                                  {0.5F, -1e-5F},
                                  {0.3F, 0.70001F}}) {
      EXPECT_LT(locate(n, at).tile, n * n) << at.x << ", " << at.y;
    }
  }
}

TEST(Tiles, AreComposedFromTheOutermostInward) {
  const SubTriangle outer = tile_part(3, 4), inner = tile_part(2, 3);
  expect_near(compose(outer, {}), outer);
  expect_near(compose({}, inner), inner);
  EXPECT_NEAR(area_of(compose(outer, inner)), area_of(outer) * area_of(inner) / 0.5, 1e-7);
  for (const Barycentrics& corner : compose(outer, inner).corner) EXPECT_TRUE(holds(outer, corner));
  // Cut twice and then three times is cut six times.
  std::map<std::uint32_t, int> times_found;
  for (std::uint32_t a = 0; a < 4; ++a) {
    for (std::uint32_t b = 0; b < 9; ++b) {
      const SubTriangle composed = compose(tile_part(2, a), tile_part(3, b));
      EXPECT_NEAR(area_of(composed), 0.5 / 36.0, 1e-7);
      ++times_found[locate(6, middle_of(composed)).tile];
    }
  }
  EXPECT_EQ(times_found.size(), 36U);
}

TEST(Tiling, IsAsFineAsAskedFor) {
  const Scene scene = test::cornell_box();
  for (const float size : {0.03F, 0.1F, 1.0F, 10.0F}) {
    const std::vector<float> areas = triangle_areas(scene);
    const Tiling tiling = make_tiles(scene, areas, size);
    const std::vector<Tile> leaves = tiling.leaves();
    EXPECT_EQ(leaves.size(), count_tiles(scene, areas, size));
    EXPECT_EQ(leaves.size(), tiling.first_child.size());
    for (const Tile& tile : leaves) EXPECT_LE(longest_edge(scene, tile.triangle, tile.part), size * 1.0001F);
  }
  EXPECT_EQ(cuts_for(scene, 0, 1e-9F), 512U);
  EXPECT_EQ(cuts_for(scene, 0, 1e9F), 1U);
}

TEST(Tiling, FindsTheLeafWhosePartHoldsThePoint) {
  const Scene scene = test::parallel_squares(1.0F);
  const Tiling tiling = unevenly_cut(scene);
  std::map<std::uint32_t, Tile> leaf;
  for (const Tile& tile : tiling.leaves()) leaf.emplace(tile.tile, tile);
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    for (const Barycentrics at : many_points()) {
      const auto found = leaf.find(tiling.tile_at(t, at));
      ASSERT_NE(found, leaf.end()) << "a tile that was cut further";
      EXPECT_EQ(found->second.triangle, t);
      EXPECT_TRUE(holds(found->second.part, at)) << at.x << ", " << at.y;
    }
  }
  for (const auto& [number, tile] : leaf) EXPECT_EQ(tiling.tile_at(tile.triangle, middle_of(tile.part)), number);
}

TEST(Tiling, CoversEachTriangleExactlyWithItsLeaves) {
  const Scene scene = test::parallel_squares(1.0F);
  const Tiling tiling = unevenly_cut(scene);
  std::vector<double> part_area(scene.triangles.size(), 0.0), area(scene.triangles.size(), 0.0);
  std::map<std::uint32_t, int> times_seen;
  for (const Tile& tile : tiling.leaves()) {
    EXPECT_EQ(++times_seen[tile.tile], 1);
    EXPECT_NEAR(area_of(tile.part) * 2.0 * double{tiling.area_of_triangle[tile.triangle]}, double{tile.area}, 1e-7);
    part_area[tile.triangle] += area_of(tile.part);
    area[tile.triangle] += double{tile.area};
  }
  for (std::size_t t = 0; t < area.size(); ++t) {
    EXPECT_NEAR(part_area[t], 0.5, 1e-6);
    EXPECT_NEAR(area[t], 0.5, 1e-6);  // half a unit square
  }
  // Where the tiles cover the area and no two overlap in a point, they cover it exactly.
  for (const Barycentrics at : many_points()) {
    int holding = 0;
    for (const Tile& tile : tiling.leaves()) {
      bool inside = tile.triangle == 0;
      for (int k = 0; k < 3 && inside; ++k) {
        inside = area_of({{tile.part.corner[k], tile.part.corner[(k + 1) % 3], at}}) > 1e-7;
      }
      holding += inside ? 1 : 0;
    }
    EXPECT_LE(holding, 1);
  }
}

TEST(Tiling, HasNoTilesInATriangleWithoutArea) {
  Scene scene = test::parallel_squares(1.0F);
  scene.triangles.insert(scene.triangles.begin(), {0, 0, 1});
  scene.surface_of_triangle.insert(scene.surface_of_triangle.begin(), 0U);
  const Tiling tiling = make_tiles(scene, triangle_areas(scene), 0.5F);
  EXPECT_EQ(tiling.tile_at(0, {0.3F, 0.3F}), kNothing);
  EXPECT_EQ(tiling.tile_at(1, {0.0F, 0.0F}), 0U);
  for (const Tile& tile : tiling.leaves()) EXPECT_NE(tile.triangle, 0U);
}

}  // namespace
}  // namespace radiosity
