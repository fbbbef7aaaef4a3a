#include "core/mesh/patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <unordered_map>

#include "core/mesh/reach.h"
#include "core/mesh/split_groups.h"
#include "core/photometry.h"

namespace radiosity {
namespace {

/// Length of a tile as a share of a patch: several tiles to a patch let it be split where a wall stands on it.
constexpr float kTileLength = 0.5F;

/// Of the limit of patches: with so many of them reached by light, smaller ones are not worth a second grouping.
constexpr float kEnoughUsed = 0.6F;

/// What tiles of one patch have in common.
struct PatchKey {
  std::array<std::int32_t, 3> cell{};
  std::uint32_t surface_and_side = 0;  // surface * 12 + facing * 2 + side
  friend bool operator==(const PatchKey&, const PatchKey&) = default;
};

struct PatchKeyHash {
  std::size_t operator()(const PatchKey& key) const {
    std::uint64_t h = key.surface_and_side;
    for (const std::int32_t c : key.cell) {
      h = (h ^ static_cast<std::uint32_t>(c)) * 0x9E3779B97F4A7C15ULL;
      h ^= h >> 29U;
    }
    return h;
  }
};

/// Which of the six axis directions a normal is closest to: neighbours that face the same way share a patch.
std::uint32_t facing(const glm::vec3& normal) {
  const glm::vec3 size = glm::abs(normal);
  int axis = 0;
  // Ties (45 degrees) go to the earlier axis even when rounding wobbles.
  for (int k = 1; k < 3; ++k) {
    if (size[k] > size[axis] * 1.001F) axis = k;
  }
  return static_cast<std::uint32_t>(2 * axis + (normal[axis] < 0.0F ? 1 : 0));
}

/// Gives each side of each tile the group of its grid cell, surface, facing and side.
class CellGroups {
 public:
  CellGroups(const Scene& scene, float size)
      : scene_(scene),
        size_(size),
        // By an odd amount, so that walls at round coordinates do not fall between two cells.
        origin_(glm::vec3(0.3819F, 0.2361F, 0.4143F) * size) {}

  std::uint32_t group_of(const Tile& tile, bool back) {
    const glm::vec3 place = glm::floor((point_at(scene_, tile.triangle, middle_of(tile.part)) - origin_) / size_);
    PatchKey key;
    for (int k = 0; k < 3; ++k) key.cell[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(place[k]);
    const std::uint32_t surface = scene_.surface_of_triangle[tile.triangle];
    key.surface_and_side = (surface * 6 + facing(scaled_normal(scene_, tile.triangle))) * 2 + (back ? 1 : 0);
    return group_of_key_.try_emplace(key, count()).first->second;
  }
  std::uint32_t count() const { return static_cast<std::uint32_t>(group_of_key_.size()); }

 private:
  const Scene& scene_;
  float size_;
  glm::vec3 origin_;
  std::unordered_map<PatchKey, std::uint32_t, PatchKeyHash> group_of_key_;
};

bool is_two_sided(const Scene& scene, std::uint32_t triangle) {
  return scene.surfaces[scene.surface_of_triangle[triangle]].two_sided;
}

/// Whether tiles of patches of this size fall into no more than `most` groups. Tiles are counted as they come, and none
/// is kept: a triangle as long as the whole scene has a quarter of a million at every size that is tried.
bool has_few_groups(const Scene& scene, std::span<const float> areas, float size, std::uint32_t most) {
  CellGroups groups(scene, size);
  for (std::uint32_t t = 0; t < areas.size(); ++t) {
    const std::uint32_t cuts = areas[t] > 0.0F ? cuts_for(scene, t, kTileLength * size) : 0;
    for (std::uint32_t k = 0; k < cuts * cuts; ++k) {
      const Tile tile{k, t, tile_part(cuts, k), 0.0F};
      groups.group_of(tile, false);
      if (is_two_sided(scene, t)) groups.group_of(tile, true);
      if (groups.count() > most) return false;
    }
  }
  return true;
}

/// Triangles are tiles, at least.
std::size_t most_tiles(std::span<const float> areas, const PatchOptions& options) {
  return std::max(options.max_tiles, 2 * areas.size());
}

/// The size of a grid cell that gives few enough groups, metres: splitting them will make more.
float choose_size(const Scene& scene, std::span<const float> areas, const PatchOptions& options,
                  bool& reached_tile_limit) {
  constexpr double kGroupsPerPatch = 0.8;
  const auto most = std::max(1U, static_cast<std::uint32_t>(kGroupsPerPatch * options.max_patches));
  const double total_area = std::accumulate(areas.begin(), areas.end(), 0.0);
  auto size = static_cast<float>(std::sqrt(total_area / options.max_patches));
  // One cell around everything cannot be merged further: as many groups as surfaces and facings.
  for (const float largest = 4.0F * diagonal(scene); size < largest; size *= 1.1F) {
    const bool too_many_tiles = count_tiles(scene, areas, kTileLength * size) > most_tiles(areas, options);
    reached_tile_limit = reached_tile_limit || too_many_tiles;
    if (!too_many_tiles && has_few_groups(scene, areas, size, most)) break;
  }
  return size;
}

/// Tiles, and the patches that their sides are grouped into.
struct Grouping {
  Tiling tiling;
  Surveys surveys;  // what is left aside is out of reach: one patch more, the last
  Parts patches;    // of the sides that take part

  std::uint32_t patch_count() const { return patches.count + (surveys.left_aside.empty() ? 0 : 1); }
};

/// Whether no light reaches a side of a tile, neither its middle nor its corners.
bool is_unreached(const Patches& patches, const Tile& tile, bool back) {
  if (patches.unreached == kNothing) return false;  // there is no tiling yet
  const Barycentrics middle = middle_of(tile.part);
  const auto unreached_at = [&](Barycentrics at) { return patches.is_unreached(tile.triangle, at, back); };
  return unreached_at(middle) &&
         std::all_of(std::begin(tile.part.corner), std::end(tile.part.corner),
                     [&](Barycentrics at) { return unreached_at(glm::mix(at, middle, 0.05F)); });
}

/// Tiles and patches of `before.size`. What is known to be out of reach there is not grouped again.
Grouping group(const RayScene& rays, std::span<const float> areas, const Patches& before, std::size_t max_tiles,
               const Progress& progress) {
  const Scene& scene = rays.scene();
  Grouping grouping{make_tiles(scene, areas, kTileLength * before.size), {}, {}};
  const auto takes_part = [&](const Tile& tile, bool back) { return !is_unreached(before, tile, back); };
  Surveys& surveys = grouping.surveys;
  surveys = cut_straddling_tiles(rays, {before.size, max_tiles}, takes_part, grouping.tiling, progress);
  CellGroups groups(scene, before.size);
  for (TileSide& side : surveys.sides) side.group = groups.group_of(surveys.tiles[side.tile], side.back);
  grouping.patches = split_groups(rays, {surveys.sides, groups.count(), before.size}, progress);
  return grouping;
}

/// Tells the tiles their patches.
void assign(const Grouping& grouping, Patches& patches) {
  const Surveys& surveys = grouping.surveys;
  patches.patch_of_tile.assign(patches.tiling.first_child.size(), kNothing);
  patches.back_patch_of_tile.assign(patches.tiling.first_child.size(), kNothing);
  const auto set = [&](const TileSide& side, std::uint32_t patch) {
    std::vector<std::uint32_t>& of_tile = side.back ? patches.back_patch_of_tile : patches.patch_of_tile;
    of_tile[surveys.tiles[side.tile].tile] = patch;
  };
  for (std::size_t s = 0; s < surveys.sides.size(); ++s) set(surveys.sides[s], grouping.patches.part_of_side[s]);
  for (const TileSide& side : surveys.left_aside) set(side, grouping.patches.count);
  patches.unreached = surveys.left_aside.empty() ? kNothing : grouping.patches.count;
}

/// Moves the sides of patches that no light reaches to the last patch.
void set_unreached_apart(std::span<const std::uint8_t> reached, Grouping& grouping) {
  std::vector<std::uint32_t> new_number(reached.size(), 0);
  std::exclusive_scan(reached.begin(), reached.end(), new_number.begin(), 0U);
  std::vector<TileSide>& sides = grouping.surveys.sides;
  std::vector<std::uint32_t>& part_of_side = grouping.patches.part_of_side;
  std::size_t kept = 0;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    if (reached[part_of_side[s]] == 0) {
      grouping.surveys.left_aside.push_back(sides[s]);
      continue;
    }
    part_of_side[kept] = new_number[part_of_side[s]];
    sides[kept++] = sides[s];
  }
  sides.resize(kept);
  part_of_side.resize(kept);
  grouping.patches.count = static_cast<std::uint32_t>(std::accumulate(reached.begin(), reached.end(), 0U));
}

/// How many patches came of a size, as a share of those that there may be.
struct Attempt {
  float size = 0.0F;  ///< metres
  float used = 0.0F;
};

/// A size for all that there may be, or a few less. Their number falls as a power of the size: its square where cells
/// cut surfaces up, less where every small surface is a patch of its own whatever the size. Two attempts tell the
/// power.
float next_size(const Attempt& now, const Attempt& before) {
  if (now.used < 1.0F) return now.size * std::sqrt(now.used) * 1.05F;
  const bool known = before.used > now.used && before.size > 0.0F && before.size < now.size;
  const float power = known ? std::log(before.used / now.used) / std::log(now.size / before.size) : 1.25F;
  return now.size * std::pow(now.used, 1.0F / std::clamp(power, 0.5F, 2.0F)) * 1.03F;
}

/// Groups tiles, sets apart what no light reaches, and does so again with larger patches while there are too many, or
/// once with smaller ones where much was out of reach.
Grouping group_reached(const RayScene& rays, std::span<const float> areas, const PatchOptions& options,
                       Patches& patches, const Progress& progress) {
  patches.size = choose_size(rays.scene(), areas, options, patches.reached_tile_limit);
  for (Attempt before{};;) {
    Grouping grouping = group(rays, areas, patches, most_tiles(areas, options), progress);
    patches.tiling = std::move(grouping.tiling);
    patches.reached_tile_limit = patches.reached_tile_limit || grouping.surveys.reached_limit;
    patches.most_tiles = std::max(patches.most_tiles, static_cast<std::uint32_t>(grouping.surveys.tiles.size()));
    assign(grouping, patches);
    set_unreached_apart(find_reached(rays, patches, grouping.patches.count, progress), grouping);
    assign(grouping, patches);
    const float used = static_cast<float>(grouping.patch_count()) / static_cast<float>(options.max_patches);
    const Attempt now{patches.size, used};
    const bool too_many = used > 1.0F && now.size < 4.0F * diagonal(rays.scene());
    const bool too_few = before.used == 0.0F && used < kEnoughUsed && !grouping.surveys.left_aside.empty();
    if (!too_many && !too_few) return grouping;
    patches.size = next_size(now, before);
    before = now;
  }
}

bool emits(const Surface& surface) { return surface.varies || luminance_of(surface.emission) > 0.0F; }

/// Sums per patch, on both sides.
struct Sums {
  explicit Sums(std::uint32_t patch_count)
      : area(patch_count, 0.0), reflectance(patch_count, glm::dvec3(0.0)), glow(patch_count, glm::dvec3(0.0)) {}
  std::vector<double> area;
  std::vector<glm::dvec3> reflectance, glow;
};

/// Calls visit(patch) for the patches at a place of a triangle that send light.
template <typename Visit>
void for_both_sides(const Patches& patches, std::uint32_t triangle, Barycentrics at, const Visit& visit) {
  for (const bool back : {false, true}) {
    const std::uint32_t patch = patches.patch_at(triangle, at, back);
    if (patch != kNothing) visit(patch);
  }
}

void sum_reflectance(const Scene& scene, std::span<const Tile> tiles, Patches& patches, Sums& sums) {
  for (const Tile& tile : tiles) {
    const Rgb rho = mean_reflectance(scene, tile.triangle, tile.part);
    if (std::max({rho.x, rho.y, rho.z}) >= kMaxReflectance) patches.reflectance_clamped_area += double{tile.area};
    for (const std::uint32_t patch : {patches.patch_of_tile[tile.tile], patches.back_patch_of_tile[tile.tile]}) {
      if (patch == kNothing) continue;
      patches.surface[patch] = scene.surface_of_triangle[tile.triangle];
      sums.area[patch] += double{tile.area};
      sums.reflectance[patch] += glm::dvec3(rho) * double{tile.area};
    }
  }
}

/// A part of a triangle that emits.
struct Emitter {
  std::uint32_t triangle;
  SubTriangle part;
  Rgb luminance;
  float area, flux;
};

/// Triangles that may emit.
std::vector<std::uint32_t> find_emissive(const Scene& scene, const Patches& patches) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const bool has_area = patches.tiling.area_of_triangle[t] > 0.0F;
    if (has_area && emits(scene.surfaces[scene.surface_of_triangle[t]])) found.push_back(t);
  }
  return found;
}

/// Length of an emitter, metres: that of a patch, or longer so that all of them can be lamps.
float emitter_length(const Scene& scene, std::span<const std::uint32_t> emissive, float patch_size) {
  float length = patch_size;
  for (const float longest = diagonal(scene); length < longest; length *= 1.25F) {
    std::uint64_t count = 0;
    for (const std::uint32_t t : emissive)
      count += std::uint64_t{cuts_for(scene, t, length)} * cuts_for(scene, t, length);
    if (count <= std::max(kMaxLamps, emissive.size())) break;
  }
  return length;
}

std::vector<Emitter> find_emitters(const Scene& scene, const Patches& patches) {
  const std::vector<std::uint32_t> emissive = find_emissive(scene, patches);
  const float length = emitter_length(scene, emissive, patches.size);
  std::vector<Emitter> emitters;
  for (const std::uint32_t t : emissive) {
    const std::uint32_t cuts = cuts_for(scene, t, length);
    const float area = patches.tiling.area_of_triangle[t] / static_cast<float>(cuts * cuts);
    for (std::uint32_t k = 0; k < cuts * cuts; ++k) {
      const SubTriangle part = tile_part(cuts, k);
      const Rgb luminance = mean_emission(scene, t, part);
      const float flux = luminance_of(luminance) * area;
      if (flux > 0.0F) emitters.push_back({t, part, luminance, area, flux});
    }
  }
  return emitters;
}

/// The emitters with most flux become lamps, the others make their patches glow.
void set_lamps_apart(const Scene& scene, Patches& patches, Sums& sums) {
  std::vector<Emitter> emitters = find_emitters(scene, patches);
  std::stable_sort(emitters.begin(), emitters.end(),
                   [](const Emitter& a, const Emitter& b) { return a.flux > b.flux; });
  double all = 0.0, glowing = 0.0;
  for (std::size_t k = 0; k < emitters.size(); ++k) {
    const Emitter& e = emitters[k];
    const Surface& surface = scene.surfaces[scene.surface_of_triangle[e.triangle]];
    const Barycentrics middle = middle_of(e.part);
    all += double{e.flux};
    if (k < kMaxLamps) {
      EmissiveTile lamp{{},
                        e.luminance,
                        surface.two_sided,
                        scene.surface_of_triangle[e.triangle],
                        undyed_brightness(surface, e.luminance)};
      for (int c = 0; c < 3; ++c) lamp.corner[c] = point_at(scene, e.triangle, e.part.corner[c]);
      patches.lamps.push_back(lamp);
      continue;
    }
    glowing += double{e.flux};
    for_both_sides(patches, e.triangle, middle,
                   [&](std::uint32_t patch) { sums.glow[patch] += glm::dvec3(e.luminance) * double{e.area}; });
  }
  patches.glow_share = all > 0.0 ? glowing / all : 0.0;
}

/// Sets what patches are made of: means over their tiles.
void average(const Scene& scene, const Grouping& grouping, Patches& patches) {
  const std::uint32_t patch_count = grouping.patch_count();
  Sums sums(patch_count);
  patches.surface.resize(patch_count);
  sum_reflectance(scene, grouping.surveys.tiles, patches, sums);
  set_lamps_apart(scene, patches, sums);
  patches.area.resize(patch_count);
  patches.reflectance.resize(patch_count);
  patches.glow.resize(patch_count);
  for (std::uint32_t p = 0; p < patch_count; ++p) {
    patches.area[p] = static_cast<float>(sums.area[p]);
    patches.reflectance[p] = Rgb(sums.reflectance[p] / sums.area[p]);
    patches.glow[p] = Rgb(sums.glow[p] / sums.area[p]);
  }
  if (patches.unreached != kNothing) patches.reflectance[patches.unreached] = Rgb(0.0F);
}

/// Spreads `points_per_patch` points over each patch, evenly by area.
void place_points(const Scene& scene, std::span<const Tile> tiles, int points_per_patch, Patches& patches) {
  patches.points_per_patch = points_per_patch;
  const std::uint32_t patch_count = patches.patch_count();
  patches.points.resize(static_cast<std::size_t>(patch_count) * static_cast<std::size_t>(points_per_patch));
  std::vector<double> covered(patch_count, 0.0);  // area passed so far, as the tiles go by
  std::vector<int> placed(patch_count, 0);

  const auto visit_side = [&](const Tile& tile, std::uint32_t patch, float side) {
    if (patch == kNothing) return;
    covered[patch] += double{tile.area};
    while (placed[patch] < points_per_patch) {
      const int k = placed[patch];
      // Starting anew at each patch at half a step, points would always fall into the same of the tiles of a cell.
      const double start = glm::fract((patch + 0.5) * 0.6180339887498949);
      const double wanted = (k + start) / points_per_patch * double{patches.area[patch]};
      if (covered[patch] < wanted * (1.0 - 1e-6)) return;

      // Several points in one tile: spread them by the R2 sequence (Roberts 2018), folded into the triangle. It runs on
      // from patch to patch: started anew at each it leaned to one side on all of them, which made whole walls 1.4 %
      // wrong (unit cube, 400 patches).
      const double step = static_cast<double>(patch) * points_per_patch + k;
      glm::vec2 at(glm::fract(glm::dvec2(0.5) + step * glm::dvec2(0.7548776662466927, 0.5698402909980532)));
      if (at.x + at.y > 1.0F) at = 1.0F - at;
      at = glm::mix(glm::vec2(1.0F / 3.0F), at, 0.9F);
      // Something may stand on the shortest tiles: their middle decided which side of it they are on.
      const bool shortest = longest_edge(scene, tile.triangle, tile.part) < kShortestCut * patches.size;
      if (shortest) at = glm::vec2(1.0F / 3.0F);
      const auto& c = tile.part.corner;
      const Barycentrics place = c[0] + at.x * (c[1] - c[0]) + at.y * (c[2] - c[0]);
      patches.points[patch * static_cast<std::size_t>(points_per_patch) + static_cast<std::size_t>(k)] = {
          point_at(scene, tile.triangle, place), side * glm::normalize(scaled_normal(scene, tile.triangle))};
      ++placed[patch];
    }
  };
  for (const Tile& tile : tiles) {
    visit_side(tile, patches.patch_of_tile[tile.tile], 1.0F);
    visit_side(tile, patches.back_patch_of_tile[tile.tile], -1.0F);
  }
}

}  // namespace

std::uint32_t Patches::patch_at(std::uint32_t triangle, Barycentrics at, bool back) const {
  const std::uint32_t tile = tiling.tile_at(triangle, at);
  if (tile == kNothing) return kNothing;
  return back ? back_patch_of_tile[tile] : patch_of_tile[tile];
}

bool Patches::is_unreached(std::uint32_t triangle, Barycentrics at, bool back) const {
  return unreached != kNothing && patch_at(triangle, at, back) == unreached;
}

std::span<const SurfacePoint> Patches::points_of(std::uint32_t patch) const {
  const auto count = static_cast<std::size_t>(points_per_patch);
  return std::span(points).subspan(patch * count, count);
}

Patches make_patches(const RayScene& rays, const PatchOptions& options, const Progress& progress) {
  progress.update("patches", 0.0);
  const Scene& scene = rays.scene();
  Patches patches;
  const std::vector<float> areas = triangle_areas(scene);
  patches.degenerate_triangle_count = static_cast<std::uint32_t>(std::count(areas.begin(), areas.end(), 0.0F));
  if (patches.degenerate_triangle_count == areas.size()) {
    patches.tiling = make_tiles(scene, areas, 1.0F);
    return patches;
  }
  const Grouping grouping = group_reached(rays, areas, options, patches, progress);
  progress.update("patches", 0.9);
  average(scene, grouping, patches);
  place_points(scene, grouping.surveys.tiles, options.points_per_patch, patches);
  progress.update("patches", 1.0);
  return patches;
}

}  // namespace radiosity
