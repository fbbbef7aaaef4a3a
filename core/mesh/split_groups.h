// Tiles that lie close together but do not see the same light are kept apart.
//
// A grid cell (patches.h) may hold floor on both sides of a thin wall, the wall behind a panel, or the ground below a
// crate. As one patch they would share their light: it leaks through. So
//   - a tile is cut in four where something stands on it: its middle does not see its corners and edges; and
//   - within a cell covered tiles are apart from open ones, and tiles go with the first tile that sees them, over a
//     little height above the surface:
//
//           o - - - - - o            o - - -|- - - o
//           |           |            |      |      |            o  lifted middles of tiles, - lines of sight
//        ___|___________|___      ___|______|______|___
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/mesh/tiles.h"
#include "core/progress.h"
#include "core/visibility/ray_scene.h"

namespace radiosity {

/// The middle of one side of a tile, lifted off the surface, and its surroundings.
struct Lookout {
  glm::vec3 lifted{0.0F};  ///< metres
  float height = 0.0F;     ///< metres above the surface, rounding apart
  bool covered = false;    ///< something lies close above
};

/// One side of a tile, and the group it is in.
struct TileSide {
  std::uint32_t tile = 0;  ///< index of its tile among the surveys
  bool back = false;
  std::uint32_t group = 0;
  Lookout lookout;
};

/// The tiles that were not cut further, and their sides, in one order; the backs only of those that send light.
struct Surveys {
  std::vector<Tile> tiles;
  std::vector<TileSide> sides;       ///< that take part
  std::vector<TileSide> left_aside;  ///< that do not: without a lookout
  bool reached_limit = false;        ///< something was not cut, for there were `max_tiles`
};

/// In shares of the size of a patch: shorter tiles are not cut, whatever stands on them.
inline constexpr float kShortestCut = 1.0F / 8.0F;

struct CutOptions {
  float patch_size = 0.0F;            ///< metres
  std::size_t max_tiles = 4'000'000;  ///< nothing is cut that would make more
};

/// Whether it matters what stands on a side (true: the back) of a tile. Thread-safe.
using TakesPart = std::function<bool(const Tile&, bool)>;

/// Cuts tiles that something stands on, down to a sixteenth of the size of a patch, and describes all that remain.
/// Throws `Cancelled`.
Surveys cut_straddling_tiles(const RayScene& rays, const CutOptions& options, const TakesPart& takes_part,
                             Tiling& tiling, const Progress& progress);

struct Groups {
  std::span<const TileSide> sides;
  std::uint32_t count = 0;
  float size = 0.0F;  ///< of a group, metres
};

/// Parts of groups whose tiles see each other, numbered from group to group.
struct Parts {
  std::vector<std::uint32_t> part_of_side;  ///< [sides.size()]
  std::uint32_t count = 0;
};

/// Does not depend on the order of triangles within a group, nor on threads. Throws `Cancelled`.
Parts split_groups(const RayScene& rays, const Groups& groups, const Progress& progress);

}  // namespace radiosity
