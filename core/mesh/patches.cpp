#include "core/mesh/patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <unordered_map>

#include "core/photometry.h"

namespace radiosity {
namespace {

constexpr std::uint32_t kMaxCuts = 512;
constexpr std::size_t kMaxTiles = 4'000'000;

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

/// One tile of the scene with what grouping needs to know of it.
struct Tile {
  std::uint32_t triangle = 0;
  SubTriangle part;
  glm::vec3 centre{0.0F};
  float area = 0.0F;
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

float longest_edge(const Scene& scene, std::uint32_t triangle) {
  const glm::uvec3& t = scene.triangles[triangle];
  const glm::vec3 a = scene.positions[t.x], b = scene.positions[t.y], c = scene.positions[t.z];
  return std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
}

std::vector<float> triangle_areas(const Scene& scene) {
  std::vector<float> areas(scene.triangles.size());
  for (std::uint32_t t = 0; t < areas.size(); ++t) areas[t] = 0.5F * glm::length(scaled_normal(scene, t));
  return areas;
}

/// How often the edges of a triangle are cut so that its tiles are no longer than `size`; 0 without area.
std::uint32_t cuts_for(const Scene& scene, std::span<const float> areas, std::uint32_t triangle, float size) {
  if (!(areas[triangle] > 0.0F)) return 0;
  const float cuts = std::ceil(longest_edge(scene, triangle) / size);
  return static_cast<std::uint32_t>(std::clamp(cuts, 1.0F, static_cast<float>(kMaxCuts)));
}

/// Cuts triangles into tiles no longer than `size`.
void cut(const Scene& scene, std::span<const float> areas, float size, Patches& patches) {
  const std::size_t count = scene.triangles.size();
  patches.cuts_of_triangle.resize(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    patches.cuts_of_triangle[t] = cuts_for(scene, areas, t, size);
  }
  patches.first_tile_of_triangle.resize(count + 1);
  std::uint64_t tiles = 0;
  for (std::size_t t = 0; t < count; ++t) {
    patches.first_tile_of_triangle[t] = static_cast<std::uint32_t>(tiles);
    tiles += std::uint64_t{patches.cuts_of_triangle[t]} * patches.cuts_of_triangle[t];
  }
  patches.first_tile_of_triangle[count] = static_cast<std::uint32_t>(tiles);
}

std::uint64_t tile_count(const Scene& scene, std::span<const float> areas, float size) {
  std::uint64_t tiles = 0;
  for (std::uint32_t t = 0; t < areas.size(); ++t) {
    const std::uint64_t cuts = cuts_for(scene, areas, t, size);
    tiles += cuts * cuts;
  }
  return tiles;
}

Tile make_tile(const Scene& scene, std::span<const float> areas, std::uint32_t triangle, std::uint32_t cuts,
               std::uint32_t index) {
  Tile tile{triangle, tile_part(cuts, index), {}, areas[triangle] / static_cast<float>(cuts * cuts)};
  const Barycentrics middle = (tile.part.corner[0] + tile.part.corner[1] + tile.part.corner[2]) / 3.0F;
  tile.centre = point_at(scene, triangle, middle);
  return tile;
}

template <typename Visit>
void for_each_tile(const Scene& scene, std::span<const float> areas, const Patches& patches, const Visit& visit) {
  std::uint32_t index = 0;
  for (std::uint32_t t = 0; t < areas.size(); ++t) {
    const std::uint32_t cuts = patches.cuts_of_triangle[t];
    for (std::uint32_t k = 0; k < cuts * cuts; ++k) visit(index++, make_tile(scene, areas, t, cuts, k));
  }
}

/// Gives each tile the patch of its grid cell, surface, facing and side. Returns the number of patches.
std::uint32_t group(const Scene& scene, std::span<const float> areas, Patches& patches) {
  std::unordered_map<PatchKey, std::uint32_t, PatchKeyHash> patch_of_key;
  const std::uint32_t tiles = patches.first_tile_of_triangle.back();
  patches.patch_of_tile.assign(tiles, kNothing);
  patches.back_patch_of_tile.assign(tiles, kNothing);

  // Off the origin by an odd amount, so that walls at round coordinates do not fall between two cells.
  const glm::vec3 origin = glm::vec3(0.3819F, 0.2361F, 0.4143F) * patches.size;
  for_each_tile(scene, areas, patches, [&](std::uint32_t index, const Tile& tile) {
    const glm::vec3 place = glm::floor((tile.centre - origin) / patches.size);
    PatchKey key;
    for (int k = 0; k < 3; ++k) key.cell[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(place[k]);
    const std::uint32_t surface = scene.surface_of_triangle[tile.triangle];
    key.surface_and_side = (surface * 6 + facing(scaled_normal(scene, tile.triangle))) * 2;
    const auto patch_of = [&](const PatchKey& k) {
      return patch_of_key.try_emplace(k, static_cast<std::uint32_t>(patch_of_key.size())).first->second;
    };
    patches.patch_of_tile[index] = patch_of(key);
    if (scene.surfaces[surface].two_sided) {
      ++key.surface_and_side;
      patches.back_patch_of_tile[index] = patch_of(key);
    }
  });
  return static_cast<std::uint32_t>(patch_of_key.size());
}

/// Chooses which emissive tiles become lamps: those with most flux.
std::vector<bool> choose_lamps(std::span<const float> flux_of_tile) {
  std::vector<std::uint32_t> emissive;
  for (std::uint32_t k = 0; k < flux_of_tile.size(); ++k) {
    if (flux_of_tile[k] > 0.0F) emissive.push_back(k);
  }
  if (emissive.size() > kMaxLamps) {
    std::nth_element(emissive.begin(), emissive.begin() + kMaxLamps, emissive.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                       return flux_of_tile[a] != flux_of_tile[b] ? flux_of_tile[a] > flux_of_tile[b] : a < b;
                     });
    emissive.resize(kMaxLamps);
  }
  std::vector<bool> lamp(flux_of_tile.size(), false);
  for (const std::uint32_t k : emissive) lamp[k] = true;
  return lamp;
}

bool emits(const Surface& surface) { return surface.varies || luminance_of(surface.emission) > 0.0F; }

/// Sums reflectance and emission of the tiles into their patches, and sets lamps apart.
void average(const Scene& scene, std::span<const float> areas, std::uint32_t patch_count, Patches& patches) {
  // Emission of each tile decides whether it is a lamp.
  std::vector<float> flux(patches.patch_of_tile.size(), 0.0F);
  for_each_tile(scene, areas, patches, [&](std::uint32_t index, const Tile& tile) {
    if (!emits(scene.surfaces[scene.surface_of_triangle[tile.triangle]])) return;
    flux[index] = luminance_of(mean_emission(scene, tile.triangle, tile.part)) * tile.area;
  });
  const std::vector<bool> is_lamp = choose_lamps(flux);

  // Sums over tiles, on both sides.
  std::vector<double> area(patch_count, 0.0);
  std::vector<glm::dvec3> reflectance(patch_count, glm::dvec3(0.0)), glow(patch_count, glm::dvec3(0.0));
  for_each_tile(scene, areas, patches, [&](std::uint32_t index, const Tile& tile) {
    const Surface& surface = scene.surfaces[scene.surface_of_triangle[tile.triangle]];
    const Rgb rho = mean_reflectance(scene, tile.triangle, tile.part);
    if (std::max({rho.x, rho.y, rho.z}) >= kMaxReflectance) patches.reflectance_clamped_area += tile.area;
    const Rgb luminance = flux[index] > 0.0F ? mean_emission(scene, tile.triangle, tile.part) : Rgb(0.0F);
    if (is_lamp[index]) {
      EmissiveTile lamp{{}, luminance, surface.two_sided, patches.patch_of_tile[index]};
      for (int k = 0; k < 3; ++k) lamp.corner[k] = point_at(scene, tile.triangle, tile.part.corner[k]);
      patches.lamps.push_back(lamp);
    }
    for (const std::uint32_t patch : {patches.patch_of_tile[index], patches.back_patch_of_tile[index]}) {
      if (patch == kNothing) continue;
      area[patch] += tile.area;
      reflectance[patch] += glm::dvec3(rho) * double{tile.area};
      if (!is_lamp[index]) glow[patch] += glm::dvec3(luminance) * double{tile.area};
    }
  });

  std::stable_sort(patches.lamps.begin(), patches.lamps.end(),
                   [](const EmissiveTile& a, const EmissiveTile& b) { return a.patch < b.patch; });

  // Sums become means.
  patches.area.resize(patch_count);
  patches.reflectance.resize(patch_count);
  patches.glow.resize(patch_count);
  for (std::uint32_t p = 0; p < patch_count; ++p) {
    patches.area[p] = static_cast<float>(area[p]);
    patches.reflectance[p] = Rgb(reflectance[p] / area[p]);
    patches.glow[p] = Rgb(glow[p] / area[p]);
  }
}

/// Spreads `points_per_patch` points over each patch, evenly by area.
void place_points(const Scene& scene, std::span<const float> areas, int points_per_patch, Patches& patches) {
  patches.points_per_patch = points_per_patch;
  const std::uint32_t patch_count = patches.patch_count();
  patches.points.resize(static_cast<std::size_t>(patch_count) * static_cast<std::size_t>(points_per_patch));
  std::vector<double> covered(patch_count, 0.0);  // area passed so far, as the tiles go by
  std::vector<int> placed(patch_count, 0);

  const auto visit_side = [&](const Tile& tile, std::uint32_t patch, float side) {
    if (patch == kNothing) return;
    covered[patch] += tile.area;
    while (placed[patch] < points_per_patch) {
      const int k = placed[patch];
      const double wanted = (k + 0.5) / points_per_patch * double{patches.area[patch]};
      if (covered[patch] < wanted * (1.0 - 1e-6)) return;

      // Several points in one tile: spread them by the R2 sequence (Roberts 2018), folded into the triangle. It runs on
      // from patch to patch: started anew at each it leaned to one side on all of them, which made whole walls 1.4 %
      // wrong (unit cube, 400 patches).
      const double step = static_cast<double>(patch) * points_per_patch + k;
      glm::vec2 at(glm::fract(glm::dvec2(0.5) + step * glm::dvec2(0.7548776662466927, 0.5698402909980532)));
      if (at.x + at.y > 1.0F) at = 1.0F - at;
      at = glm::mix(glm::vec2(1.0F / 3.0F), at, 0.9F);
      const auto& c = tile.part.corner;
      const Barycentrics place = c[0] + at.x * (c[1] - c[0]) + at.y * (c[2] - c[0]);
      patches.points[patch * static_cast<std::size_t>(points_per_patch) + static_cast<std::size_t>(k)] = {
          point_at(scene, tile.triangle, place), side * glm::normalize(scaled_normal(scene, tile.triangle))};
      ++placed[patch];
    }
  };
  for_each_tile(scene, areas, patches, [&](std::uint32_t index, const Tile& tile) {
    visit_side(tile, patches.patch_of_tile[index], 1.0F);
    visit_side(tile, patches.back_patch_of_tile[index], -1.0F);
  });
}

}  // namespace

SubTriangle tile_part(std::uint32_t cuts, std::uint32_t tile) {
  // The row whose first tile is the last not beyond `tile`: rows start at j (2n - j).
  std::uint32_t j = 0;
  while ((j + 1) * (2 * cuts - (j + 1)) <= tile) ++j;
  const std::uint32_t in_row = tile - j * (2 * cuts - j);
  const float step = 1.0F / static_cast<float>(cuts);
  const auto corner = [&](std::uint32_t x, std::uint32_t y) {
    return Barycentrics(static_cast<float>(x) * step, static_cast<float>(y) * step);
  };
  const std::uint32_t i = in_row / 2;
  if (in_row % 2 == 0) return {{corner(i, j), corner(i + 1, j), corner(i, j + 1)}};
  return {{corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)}};
}

std::uint32_t tile_at(std::uint32_t cuts, Barycentrics at) {
  const float n = static_cast<float>(cuts);
  const float x = std::clamp(at.x, 0.0F, 1.0F) * n, y = std::clamp(at.y, 0.0F, 1.0F) * n;
  const std::uint32_t j = std::min(static_cast<std::uint32_t>(y), cuts - 1);
  const std::uint32_t i = std::min(static_cast<std::uint32_t>(x), cuts - 1 - j);
  const bool upper = i + j + 1 < cuts && (x - static_cast<float>(i)) + (y - static_cast<float>(j)) > 1.0F;
  return j * (2 * cuts - j) + 2 * i + (upper ? 1U : 0U);
}

std::uint32_t Patches::patch_at(std::uint32_t triangle, Barycentrics at, bool back) const {
  const std::uint32_t cuts = cuts_of_triangle[triangle];
  if (cuts == 0) return kNothing;
  const std::uint32_t tile = first_tile_of_triangle[triangle] + tile_at(cuts, at);
  return back ? back_patch_of_tile[tile] : patch_of_tile[tile];
}

std::span<const SurfacePoint> Patches::points_of(std::uint32_t patch) const {
  const auto count = static_cast<std::size_t>(points_per_patch);
  return std::span(points).subspan(patch * count, count);
}

Patches make_patches(const Scene& scene, const PatchOptions& options, const Progress& progress) {
  progress.update("patches", 0.0);
  Patches patches;
  const std::vector<float> areas = triangle_areas(scene);
  const double total_area = std::accumulate(areas.begin(), areas.end(), 0.0);
  patches.degenerate_triangle_count = static_cast<std::uint32_t>(std::count(areas.begin(), areas.end(), 0.0F));
  if (!(total_area > 0.0)) {
    cut(scene, areas, 1.0F, patches);
    return patches;
  }

  // Grow the cells until few enough patches remain. Two thirds of the allowed number is a first guess for flat walls,
  // which cells cut into squares and leftovers.
  const auto wanted = static_cast<double>(options.max_patches) * 2.0 / 3.0;
  patches.size = static_cast<float>(std::sqrt(total_area / wanted));
  std::uint32_t patch_count = 0;
  for (;; patches.size *= 1.25F) {
    progress.update("patches", 0.1);
    if (tile_count(scene, areas, patches.size) > std::max(kMaxTiles, 2 * areas.size())) continue;
    cut(scene, areas, patches.size, patches);
    patch_count = group(scene, areas, patches);
    if (patch_count <= static_cast<std::uint32_t>(options.max_patches)) break;
    // One cell around everything cannot be merged further: as many patches as surfaces and facings.
    if (patches.size > 4.0F * diagonal(scene)) break;
  }

  progress.update("patches", 0.5);
  average(scene, areas, patch_count, patches);
  place_points(scene, areas, options.points_per_patch, patches);
  progress.update("patches", 1.0);
  return patches;
}

}  // namespace radiosity
