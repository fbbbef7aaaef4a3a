#include "core/mesh/split_groups.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/parallel.h"
#include "core/visibility/hemicube.h"
#include "core/visibility/occlusion.h"

namespace radiosity {
namespace {

/// In shares of the size of a patch: what is nearer than this covers a tile, and lines of sight run this high.
constexpr float kCover = 0.25F, kHeight = 0.1F;

/// A tile is covered if this many of five rays (one along the normal, four slanted by 45 degrees) meet something near.
constexpr int kCoveringRays = 4;

/// Parts of one group at most: in a thicket nothing sees anything.
constexpr std::size_t kMaxParts = 6;

/// The surroundings of tiles, at the scale of a patch.
class Surveyor {
 public:
  Surveyor(const RayScene& rays, float patch_size)
      : rays_(rays), size_(patch_size), offset_(surface_offset(rays.scene())) {}

  Lookout lookout(const Tile& tile, bool back) const {
    const glm::vec3 normal = normal_of(tile, back);
    const glm::vec3 from = point_at(rays_.scene(), tile.triangle, middle_of(tile.part)) + offset_ * normal;
    const Frame axes = frame({from, normal, 0.0F});
    const std::array<glm::vec3, 5> directions{normal, glm::normalize(normal + axes.u), glm::normalize(normal - axes.u),
                                              glm::normalize(normal + axes.v), glm::normalize(normal - axes.v)};
    std::array<ShadowRay, 5> rays;
    std::array<std::uint8_t, 5> blocked{};
    for (std::size_t k = 0; k < rays.size(); ++k) rays[k] = {from, directions[k], kCover * size_, 0.5F};
    trace_shadow_rays(rays_, rays, blocked);
    const bool covered = std::accumulate(blocked.begin(), blocked.end(), 0) >= kCoveringRays;
    const float height = blocked[0] != 0 ? 0.0F : kHeight * size_;
    return {from + height * normal, height, covered};
  }

  /// Whether something stands on a tile: its corners and the middles of its edges are hidden from its middle.
  bool straddles(const Tile& tile, bool back, const Lookout& middle) const {
    const glm::vec3 lift = (offset_ + middle.height) * normal_of(tile, back);
    const Barycentrics centre = middle_of(tile.part);
    std::array<ShadowRay, 6> rays;
    std::array<std::uint8_t, 6> blocked{};
    for (std::size_t k = 0; k < 3; ++k) {
      // A little inside, where no neighbour stands on the edge.
      const Barycentrics corner = glm::mix(tile.part.corner[k], centre, 0.05F);
      const Barycentrics edge = glm::mix(0.5F * (tile.part.corner[k] + tile.part.corner[(k + 1) % 3]), centre, 0.05F);
      rays[2 * k] = sight(middle.lifted, point_at(rays_.scene(), tile.triangle, corner) + lift);
      rays[2 * k + 1] = sight(middle.lifted, point_at(rays_.scene(), tile.triangle, edge) + lift);
    }
    trace_shadow_rays(rays_, rays, blocked);
    return std::accumulate(blocked.begin(), blocked.end(), 0) > 0;
  }

  bool may_be_cut(const Tile& tile) const {
    return longest_edge(rays_.scene(), tile.triangle, tile.part) >= kShortestCut * size_;
  }

  /// Which of `others` see `founder` and are covered as it is.
  std::vector<std::uint8_t> company(const Lookout& founder, std::span<const Lookout> others) const {
    std::vector<ShadowRay> rays(others.size());
    for (std::size_t k = 0; k < rays.size(); ++k) rays[k] = sight(founder.lifted, others[k].lifted);
    std::vector<std::uint8_t> blocked(rays.size(), 0), belongs(rays.size(), 0);
    trace_shadow_rays(rays_, rays, blocked);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      belongs[k] = blocked[k] == 0 && others[k].covered == founder.covered ? 1 : 0;
    }
    return belongs;
  }

 private:
  glm::vec3 normal_of(const Tile& tile, bool back) const {
    const glm::vec3 scaled = scaled_normal(rays_.scene(), tile.triangle);
    return glm::normalize(back ? -scaled : scaled);
  }

  ShadowRay sight(const glm::vec3& from, const glm::vec3& to) const {
    const float distance = glm::distance(from, to);
    return {from, (to - from) / std::max(distance, 1e-20F), std::max(0.0F, distance - 2.0F * offset_), 0.5F};
  }

  const RayScene& rays_;
  float size_, offset_;
};

/// The founder for a lookout that sees none: covered alike before near.
std::uint32_t nearest_founder(const Lookout& lookout, std::span<const Lookout> founders) {
  const auto order = [&](const Lookout& founder) {
    return std::pair(founder.covered != lookout.covered, glm::distance(founder.lifted, lookout.lifted));
  };
  const auto nearest = std::min_element(founders.begin(), founders.end(),
                                        [&](const Lookout& a, const Lookout& b) { return order(a) < order(b); });
  return static_cast<std::uint32_t>(nearest - founders.begin());
}

/// The part of each lookout of one group, and how many parts there are: the first lookout founds a part, to which all
/// belong that see it; the first of those that are left founds the next one.
std::uint32_t part_lookouts(const Surveyor& surveyor, std::span<const Lookout> lookouts,
                            std::span<std::uint32_t> part) {
  std::vector<std::uint32_t> left(lookouts.size());
  std::iota(left.begin(), left.end(), 0U);
  std::vector<Lookout> founders, others;
  while (!left.empty() && founders.size() < kMaxParts) {
    const Lookout& founder = founders.emplace_back(lookouts[left.front()]);
    others.clear();
    for (const std::uint32_t k : left) others.push_back(lookouts[k]);
    const std::vector<std::uint8_t> belongs = surveyor.company(founder, others);
    std::vector<std::uint32_t> still_left;
    for (std::size_t k = 0; k < left.size(); ++k) {
      if (k == 0 || belongs[k] != 0) {
        part[left[k]] = static_cast<std::uint32_t>(founders.size() - 1);
      } else {
        still_left.push_back(left[k]);
      }
    }
    left = std::move(still_left);
  }
  for (const std::uint32_t k : left) part[k] = nearest_founder(lookouts[k], founders);
  return static_cast<std::uint32_t>(founders.size());
}

/// Sides sorted by group, and where each group starts, [count + 1].
struct Sorted {
  std::vector<std::uint32_t> side, first;
};

Sorted sort_by_group(const Groups& groups) {
  Sorted sorted{std::vector<std::uint32_t>(groups.sides.size()), std::vector<std::uint32_t>(groups.count + 1, 0)};
  for (const TileSide& side : groups.sides) ++sorted.first[side.group + 1];
  std::partial_sum(sorted.first.begin(), sorted.first.end(), sorted.first.begin());
  std::vector<std::uint32_t> next(sorted.first.begin(), sorted.first.end() - 1);
  for (std::uint32_t s = 0; s < groups.sides.size(); ++s) sorted.side[next[groups.sides[s].group]++] = s;
  return sorted;
}

/// What is seen from one tile.
struct Look {
  Lookout side[2];
  bool takes_part[2] = {false, false};
  bool cut = false;
};

Look look_around(const Surveyor& surveyor, const Tile& tile, bool two_sided, const TakesPart& takes_part) {
  Look look;
  const bool may_be_cut = surveyor.may_be_cut(tile);
  for (int back = 0; back <= (two_sided ? 1 : 0); ++back) {
    look.takes_part[back] = takes_part(tile, back != 0);
    if (!look.takes_part[back]) continue;
    look.side[back] = surveyor.lookout(tile, back != 0);
    look.cut = look.cut || (may_be_cut && surveyor.straddles(tile, back != 0, look.side[back]));
  }
  return look;
}

void cut_in_four(const Tile& tile, Tiling& tiling, std::vector<Tile>& quarters) {
  const auto child = static_cast<std::uint32_t>(tiling.first_child.size());
  tiling.first_child[tile.tile] = child;
  tiling.first_child.resize(child + 4, kNothing);
  for (std::uint32_t c = 0; c < 4; ++c) {
    quarters.push_back({child + c, tile.triangle, compose(tile.part, tile_part(2, c)), 0.25F * tile.area});
  }
}

void keep(const Tile& tile, const Look& look, bool two_sided, Surveys& surveys) {
  const auto index = static_cast<std::uint32_t>(surveys.tiles.size());
  surveys.tiles.push_back(tile);
  for (int back = 0; back <= (two_sided ? 1 : 0); ++back) {
    (look.takes_part[back] ? surveys.sides : surveys.left_aside).push_back({index, back != 0, 0, look.side[back]});
  }
}

}  // namespace

Surveys cut_straddling_tiles(const RayScene& rays, const CutOptions& options, const TakesPart& takes_part,
                             Tiling& tiling, const Progress& progress) {
  constexpr std::size_t kBlock = std::size_t{1} << 17U;  // so that looks take 7 MB and not more than what is kept
  const Scene& scene = rays.scene();
  const Surveyor surveyor(rays, options.patch_size);
  const auto is_two_sided = [&](const Tile& tile) {
    return scene.surfaces[scene.surface_of_triangle[tile.triangle]].two_sided;
  };
  std::vector<Tile> tiles = tiling.leaves(), quarters;
  Surveys surveys;
  surveys.tiles.reserve(tiles.size());
  surveys.sides.reserve(tiles.size());
  std::vector<Look> looks;
  for (; !tiles.empty(); tiles = std::exchange(quarters, {})) {
    for (std::size_t first = 0; first < tiles.size(); first += kBlock) {
      const std::span block = std::span<const Tile>(tiles).subspan(first, std::min(kBlock, tiles.size() - first));
      looks.resize(block.size());
      parallel_in_chunks(block.size(), 4096, progress, "patches", [&](std::size_t k) {
        looks[k] = look_around(surveyor, block[k], is_two_sided(block[k]), takes_part);
      });
      for (std::size_t k = 0; k < block.size(); ++k) {
        const std::size_t count = surveys.tiles.size() + quarters.size() + (tiles.size() - first - k);
        const bool has_room = count + 3 <= options.max_tiles;
        surveys.reached_limit = surveys.reached_limit || (looks[k].cut && !has_room);
        if (looks[k].cut && has_room) {
          cut_in_four(block[k], tiling, quarters);
        } else {
          keep(block[k], looks[k], is_two_sided(block[k]), surveys);
        }
      }
    }
  }
  return surveys;
}

Parts split_groups(const RayScene& rays, const Groups& groups, const Progress& progress) {
  const Surveyor surveyor(rays, groups.size);
  const Sorted sorted = sort_by_group(groups);
  Parts parts{std::vector<std::uint32_t>(groups.sides.size(), 0), 0};
  std::vector<std::uint32_t> part_count(groups.count, 0);
  parallel_in_chunks(groups.count, 256, progress, "patches", [&](std::size_t group) {
    // By place, so that the order of triangles does not decide who founds a part.
    std::vector<std::uint32_t> members(sorted.side.begin() + sorted.first[group],
                                       sorted.side.begin() + sorted.first[group + 1]);
    std::sort(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
      const glm::vec3 &p = groups.sides[a].lookout.lifted, &q = groups.sides[b].lookout.lifted;
      return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
    });
    std::vector<Lookout> lookouts;
    lookouts.reserve(members.size());
    for (const std::uint32_t s : members) lookouts.push_back(groups.sides[s].lookout);
    std::vector<std::uint32_t> part(members.size());
    part_count[group] = part_lookouts(surveyor, lookouts, part);
    for (std::size_t k = 0; k < members.size(); ++k) parts.part_of_side[members[k]] = part[k];
  });

  // Numbers within groups become numbers of all.
  std::vector<std::uint32_t> first_part(groups.count, 0);
  std::exclusive_scan(part_count.begin(), part_count.end(), first_part.begin(), 0U);
  for (std::size_t s = 0; s < groups.sides.size(); ++s) parts.part_of_side[s] += first_part[groups.sides[s].group];
  parts.count = std::accumulate(part_count.begin(), part_count.end(), 0U);
  return parts;
}

}  // namespace radiosity
