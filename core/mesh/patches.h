// Patches: the coarse, nearly flat groups of surface that send light as a unit.
//
// Every triangle is cut into congruent tiles half as long as a patch (tiles.h); tiles of one surface that lie in the
// same cell of a regular grid, face the same way and see each other (split_groups.h) form a patch. So large triangles
// are cut and dense meshes are grouped by one rule, the cost of the solution depends on neither, and the patch that a
// ray hits follows from its barycentric coordinates by arithmetic.
//
// A surface that sends on both sides has two patches at each place, one for either side. All that no light can reach
// (reach.h) is one patch, which sends none: what is left of the limit goes to what is lit.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/tiles.h"
#include "core/progress.h"
#include "core/scene.h"
#include "core/visibility/ray_scene.h"

namespace radiosity {

/// A place on a surface where light is looked at.
struct SurfacePoint {
  glm::vec3 position{0.0F};  ///< metres, on the surface
  glm::vec3 normal{0.0F};    ///< unit, towards the side that is meant
};

/// One of the n x n congruent parts of a triangle that emits light by itself.
struct EmissiveTile {
  glm::vec3 corner[3];  ///< metres, counter-clockwise seen from the front
  Rgb luminance{0.0F};  ///< mean over the tile, cd/m2
  bool two_sided = false;
  std::uint32_t surface = 0;  ///< of the scene
  float brightness = 0.0F;    ///< beside others of its surface, see undyed_brightness()
};

struct PatchOptions {
  int max_patches = 4000;             ///< tiles are made larger until no more patches than this remain, >= 1
  int points_per_patch = 4;           ///< where form factors and direct light of a patch are measured, >= 1
  std::size_t max_tiles = 4'000'000;  ///< or twice as many as triangles, if that is more
};

/// Shapes: per triangle [triangle_count], per tile [tile_count], per patch [patch_count()].
struct Patches {
  float size = 0.0F;  ///< edge of the grid's cells, metres

  Tiling tiling;
  std::vector<std::uint32_t> patch_of_tile;       ///< the patch of the front
  std::vector<std::uint32_t> back_patch_of_tile;  ///< the patch of the back; kNothing where the back only blocks

  std::vector<float> area;             ///< m2
  std::vector<Rgb> reflectance;        ///< area-weighted mean, at most kMaxReflectance
  std::vector<Rgb> glow;               ///< mean luminance that is not in `lamps`, cd/m2
  std::vector<std::uint32_t> surface;  ///< of the scene; of the unreached patch: that of some part of it
  std::vector<SurfacePoint> points;    ///< [patch_count() * points_per_patch]
  int points_per_patch = 0;

  /// What emits, as far as it is worth shadow rays: the parts with most flux, at most kMaxLamps, brightest first.
  /// Patches keep the emission of the rest as `glow`, which hemicubes see.
  std::vector<EmissiveTile> lamps;
  double glow_share = 0.0;  ///< how much of the emitted flux is left to `glow`, [0,1]

  double reflectance_clamped_area = 0.0;  ///< m2 whose reflectance was lowered to kMaxReflectance
  std::uint32_t degenerate_triangle_count = 0;
  bool reached_tile_limit = false;     ///< PatchOptions::max_tiles kept tiles larger than wanted
  std::uint32_t most_tiles = 0;        ///< leaves of the largest tiling that was tried
  std::uint32_t unreached = kNothing;  ///< the patch of all that no light reaches, of reflectance 0; kNothing: none

  std::uint32_t patch_count() const { return static_cast<std::uint32_t>(area.size()); }
  /// The patch that shows its light at a point of a triangle; kNothing if that side sends none.
  std::uint32_t patch_at(std::uint32_t triangle, Barycentrics at, bool back) const;
  /// Whether a side that sends light is one that no light reaches.
  bool is_unreached(std::uint32_t triangle, Barycentrics at, bool back) const;
  std::span<const SurfacePoint> points_of(std::uint32_t patch) const;
};

inline constexpr std::size_t kMaxLamps = 8192;

/// The patches of the scene of `rays`. Deterministic; linear in the number of tiles. Throws `Cancelled`.
Patches make_patches(const RayScene& rays, const PatchOptions& options, const Progress& progress);

}  // namespace radiosity
