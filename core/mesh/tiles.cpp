#include "core/mesh/tiles.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace radiosity {
namespace {

constexpr std::uint32_t kMaxCuts = 512;

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

PlaceInTile locate(std::uint32_t cuts, Barycentrics at) {
  const float n = static_cast<float>(cuts);
  const float x = std::clamp(at.x, 0.0F, 1.0F) * n, y = std::clamp(at.y, 0.0F, 1.0F) * n;
  const std::uint32_t j = std::min(static_cast<std::uint32_t>(y), cuts - 1);
  const std::uint32_t i = std::min(static_cast<std::uint32_t>(x), cuts - 1 - j);
  const std::uint32_t tile = j * (2 * cuts - j) + 2 * i;
  const float right = x - static_cast<float>(i), up = y - static_cast<float>(j);
  if (i + j + 1 < cuts && right + up > 1.0F) return {tile + 1, {right + up - 1.0F, 1.0F - right}};
  return {tile, {right, up}};
}

SubTriangle compose(const SubTriangle& outer, const SubTriangle& inner) {
  const auto& c = outer.corner;
  SubTriangle composed;
  for (int k = 0; k < 3; ++k) {
    composed.corner[k] = c[0] + inner.corner[k].x * (c[1] - c[0]) + inner.corner[k].y * (c[2] - c[0]);
  }
  return composed;
}

Barycentrics middle_of(const SubTriangle& part) { return (part.corner[0] + part.corner[1] + part.corner[2]) / 3.0F; }

std::uint32_t Tiling::tile_at(std::uint32_t triangle, Barycentrics at) const {
  const std::uint32_t cuts = cuts_of_triangle[triangle];
  if (cuts == 0) return kNothing;
  PlaceInTile place = locate(cuts, at);
  std::uint32_t tile = first_of_triangle[triangle] + place.tile;
  while (first_child[tile] != kNothing) {
    place = locate(2, place.at);
    tile = first_child[tile] + place.tile;
  }
  return tile;
}

void Tiling::for_each_leaf(const std::function<void(const Tile&)>& visit) const {
  std::vector<Tile> open;
  for (std::uint32_t t = 0; t < cuts_of_triangle.size(); ++t) {
    const std::uint32_t cuts = cuts_of_triangle[t];
    for (std::uint32_t k = 0; k < cuts * cuts; ++k) {
      const float area = area_of_triangle[t] / static_cast<float>(cuts * cuts);
      open.push_back({first_of_triangle[t] + k, t, tile_part(cuts, k), area});
      while (!open.empty()) {
        const Tile tile = open.back();
        open.pop_back();
        const std::uint32_t child = first_child[tile.tile];
        if (child == kNothing) visit(tile);
        for (std::uint32_t c = 0; child != kNothing && c < 4; ++c) {
          open.push_back({child + c, t, compose(tile.part, tile_part(2, c)), 0.25F * tile.area});
        }
      }
    }
  }
}

std::vector<Tile> Tiling::leaves() const {
  std::vector<Tile> found;
  found.reserve(first_child.size());
  for_each_leaf([&](const Tile& tile) { found.push_back(tile); });
  return found;
}

std::vector<float> triangle_areas(const Scene& scene) {
  std::vector<float> areas(scene.triangles.size());
  for (std::uint32_t t = 0; t < areas.size(); ++t) areas[t] = 0.5F * glm::length(scaled_normal(scene, t));
  return areas;
}

float longest_edge(const Scene& scene, std::uint32_t triangle, const SubTriangle& part) {
  const glm::vec3 a = point_at(scene, triangle, part.corner[0]), b = point_at(scene, triangle, part.corner[1]),
                  c = point_at(scene, triangle, part.corner[2]);
  return std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
}

std::uint32_t cuts_for(const Scene& scene, std::uint32_t triangle, float size) {
  const float cuts = std::ceil(longest_edge(scene, triangle, {}) / size);
  return static_cast<std::uint32_t>(std::clamp(cuts, 1.0F, static_cast<float>(kMaxCuts)));
}

Tiling make_tiles(const Scene& scene, std::span<const float> areas, float size) {
  const std::size_t count = scene.triangles.size();
  Tiling tiling{{areas.begin(), areas.end()}, std::vector<std::uint32_t>(count), {}, {}};
  tiling.first_of_triangle.reserve(count);
  std::uint32_t tiles = 0;
  for (std::uint32_t t = 0; t < count; ++t) {
    const std::uint32_t cuts = areas[t] > 0.0F ? cuts_for(scene, t, size) : 0;
    tiling.cuts_of_triangle[t] = cuts;
    tiling.first_of_triangle.push_back(tiles);
    tiles += cuts * cuts;
  }
  tiling.first_child.assign(tiles, kNothing);
  return tiling;
}

std::uint64_t count_tiles(const Scene& scene, std::span<const float> areas, float size) {
  std::uint64_t tiles = 0;
  for (std::uint32_t t = 0; t < areas.size(); ++t) {
    if (!(areas[t] > 0.0F)) continue;
    const std::uint64_t cuts = cuts_for(scene, t, size);
    tiles += cuts * cuts;
  }
  return tiles;
}

}  // namespace radiosity
