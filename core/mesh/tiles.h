// Triangles cut into tiles: first n x n congruent ones, then any of them in four, again and again, where it must be
// finer. Which tile holds a point of a triangle follows from its barycentric coordinates by arithmetic.
//
//        /\          j = 1                                                                                            .
//       /__\                          tile (i, j, upper) of a triangle cut n = 2 times;                               .
//      /\  /\        j = 0            numbered by rows: j (2n - j) + 2i + upper                                       .
//     /__\/__\                                                                                                        .
//      i=0 i=1
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/scene.h"

namespace radiosity {

/// Part of its triangle that a tile covers. REQUIRES: tile < cuts * cuts.
SubTriangle tile_part(std::uint32_t cuts, std::uint32_t tile);

/// The tile of a triangle cut `cuts` times that holds a point, and where in the tile.
struct PlaceInTile {
  std::uint32_t tile;
  Barycentrics at;
};
PlaceInTile locate(std::uint32_t cuts, Barycentrics at);

/// `inner`, a part of `outer`, as a part of what `outer` is a part of.
SubTriangle compose(const SubTriangle& outer, const SubTriangle& inner);

Barycentrics middle_of(const SubTriangle& part);

/// A tile that was not cut further.
struct Tile {
  std::uint32_t tile;      ///< its number
  std::uint32_t triangle;  ///< of the scene
  SubTriangle part;        ///< of the triangle
  float area;              ///< m2
};

/// The tiles of all triangles, numbered from triangle to triangle; those that others were cut into come behind.
struct Tiling {
  std::vector<float> area_of_triangle;           ///< m2, [triangle_count]
  std::vector<std::uint32_t> cuts_of_triangle;   ///< n: the triangle was cut into n * n tiles; 0 without area
  std::vector<std::uint32_t> first_of_triangle;  ///< [triangle_count]
  std::vector<std::uint32_t> first_child;        ///< [tile_count]: the first of the four it was cut into, or kNothing

  /// The tile that holds a point; kNothing in a triangle without area.
  std::uint32_t tile_at(std::uint32_t triangle, Barycentrics at) const;
  /// Every tile that was not cut further, in order of place.
  void for_each_leaf(const std::function<void(const Tile&)>& visit) const;
  std::vector<Tile> leaves() const;
};

/// m2, [triangle_count].
std::vector<float> triangle_areas(const Scene& scene);

/// Longest edge of a part of a triangle, metres.
float longest_edge(const Scene& scene, std::uint32_t triangle, const SubTriangle& part);

/// How often the edges of a triangle are cut so that its tiles are no longer than `size` (m), at least once.
std::uint32_t cuts_for(const Scene& scene, std::uint32_t triangle, float size);

/// Tiles no longer than `size` (m), or about: a triangle has 512 x 512 at most.
Tiling make_tiles(const Scene& scene, std::span<const float> areas, float size);

/// How many tiles make_tiles() would make.
std::uint64_t count_tiles(const Scene& scene, std::span<const float> areas, float size);

}  // namespace radiosity
