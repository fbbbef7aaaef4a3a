#include "core/transport/lamps.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/photometry.h"

namespace radiosity {
namespace {

/// Beyond this many edge lengths a lamp counts as a point: 1/2 per cent wrong at most.
constexpr float kPointLike = 6.0F;

/// Beyond this many radii a group counts as one lamp: (1/16)^2 wrong at most, in the light of that group. While groups
/// were weighed by rough estimates and rays brought single lamps' light, that noise made a white furnace 4 % wrong at
/// single vertices with 8 rays, 1 % with 32.
constexpr float kFar = 16.0F;

/// A group whose mean normal is longer than this counts as flat, and than this as flat but for rounding.
constexpr float kFlat = 0.95F, kPlane = 1.0F - 1e-6F;

/// A polygon cut off at a horizon: a triangle keeps at most four corners.
struct LampOutline {
  glm::vec3 corner[4];
  int count = 0;
};

/// The part of a triangle above the plane through the origin. Sutherland and Hodgman, Reentrant Polygon Clipping,
/// 1974.
LampOutline above_horizon(const glm::vec3 corner[3], const SurfacePoint& at) {
  glm::vec3 relative[3];
  float height[3];
  for (int k = 0; k < 3; ++k) {
    relative[k] = corner[k] - at.position;
    height[k] = glm::dot(relative[k], at.normal);
  }
  LampOutline polygon;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    if (height[k] > 0.0F) polygon.corner[polygon.count++] = relative[k];
    if ((height[k] > 0.0F) != (height[next] > 0.0F)) {
      const float t = height[k] / (height[k] - height[next]);
      polygon.corner[polygon.count++] = glm::mix(relative[k], relative[next], t);
    }
  }
  return polygon;
}

glm::vec3 scaled_normal(const EmissiveTile& lamp) {
  return 0.5F * glm::cross(lamp.corner[1] - lamp.corner[0], lamp.corner[2] - lamp.corner[0]);
}

glm::vec3 middle_of(const EmissiveTile& lamp) { return (lamp.corner[0] + lamp.corner[1] + lamp.corner[2]) / 3.0F; }

double flux_of(const EmissiveTile& lamp) { return double{glm::length(scaled_normal(lamp))} * double{lamp.brightness}; }

/// Irradiance at unit luminance from a lamp so far off that it counts as a point.
float point_like_irradiance(const EmissiveTile& lamp, const SurfacePoint& at) {
  const glm::vec3 to_lamp = middle_of(lamp) - at.position;
  const float d2 = glm::dot(to_lamp, to_lamp);
  const float at_lamp = -glm::dot(scaled_normal(lamp), to_lamp), here = glm::dot(at.normal, to_lamp);
  return here <= 0.0F ? 0.0F : at_lamp * here / (d2 * d2);
}

/// Whether a point lies in a lamp's plane, as the lamp's own points do. Rounding would decide whether it sees nothing
/// of the lamp or, from the back of a two-sided one, nothing else.
bool in_plane(const EmissiveTile& lamp, const glm::vec3& point, float tolerance) {
  const glm::vec3 scaled = scaled_normal(lamp);
  return std::abs(glm::dot(scaled, point - lamp.corner[0])) <= tolerance * glm::length(scaled);
}

}  // namespace

float triangle_irradiance(const glm::vec3 corner[3], const SurfacePoint& at) {
  const LampOutline polygon = above_horizon(corner, at);
  if (polygon.count < 3) return 0.0F;

  // Lambert: half the sum, over the edges, of the angle each spans times the cosine to its plane's normal.
  double sum = 0.0;
  for (int k = 0; k < polygon.count; ++k) {
    const glm::dvec3 a = polygon.corner[k], b = polygon.corner[(k + 1) % polygon.count];
    const glm::dvec3 normal = glm::cross(a, b);
    const double sine = glm::length(normal);
    if (sine > 0.0) sum += std::atan2(sine, glm::dot(a, b)) / sine * glm::dot(normal, glm::dvec3(at.normal));
  }
  return static_cast<float>(-0.5 * sum);
}

Lamps::Lamps(std::span<const EmissiveTile> tiles, float surface_offset)
    : tiles_(tiles.begin(), tiles.end()), surface_offset_(surface_offset) {
  // A tree for each surface.
  std::ranges::stable_sort(tiles_, {}, &EmissiveTile::surface);
  for (auto first = tiles_.begin(); first != tiles_.end();) {
    const auto last = std::ranges::upper_bound(first, tiles_.end(), first->surface, {}, &EmissiveTile::surface);
    const auto start = static_cast<std::uint32_t>(first - tiles_.begin());
    roots_.push_back(build(start, static_cast<std::uint32_t>(last - first)));
    first = last;
  }

  // Reach of each lamp, and the running flux.
  reach2_.reserve(tiles_.size());
  flux_until_.assign(1, 0.0);
  for (const EmissiveTile& lamp : tiles_) {
    float longest = 0.0F;
    for (int k = 0; k < 3; ++k) longest = std::max(longest, glm::distance(lamp.corner[k], lamp.corner[(k + 1) % 3]));
    reach2_.push_back(kPointLike * kPointLike * longest * longest);
    flux_until_.push_back(flux_until_.back() + flux_of(lamp));
  }
}

std::uint32_t Lamps::build(std::uint32_t first, std::uint32_t count) {
  const auto group = static_cast<std::uint32_t>(groups_.size());
  groups_.push_back(describe(first, count));
  if (count == 1) return group;

  // Lamps that face different ways part first: what a flat group brings from afar is easily estimated. Then halves.
  const auto begin = tiles_.begin() + first, end = begin + count;
  const bool flat = glm::length(groups_[group].facing) > kFlat;
  const auto key = [flat](const EmissiveTile& lamp) {
    return flat ? middle_of(lamp) : glm::normalize(scaled_normal(lamp));
  };
  glm::vec3 low = key(*begin), high = low;
  for (auto lamp = begin; lamp != end; ++lamp) {
    low = glm::min(low, key(*lamp));
    high = glm::max(high, key(*lamp));
  }
  const glm::vec3 extent = high - low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  std::stable_sort(begin, end,
                   [&](const EmissiveTile& a, const EmissiveTile& b) { return key(a)[axis] < key(b)[axis]; });
  const float middle = 0.5F * (low[axis] + high[axis]);
  const auto split =
      flat ? begin + count / 2
           : std::partition_point(begin, end, [&](const EmissiveTile& lamp) { return key(lamp)[axis] < middle; });
  const auto nearer = std::clamp(static_cast<std::uint32_t>(split - begin), 1U, count - 1);
  build(first, nearer);
  const std::uint32_t second = build(first + nearer, count - nearer);
  groups_[group].second_child = second;
  return group;
}

Lamps::Group Lamps::describe(std::uint32_t first, std::uint32_t count) const {
  Group group{.first = first, .count = count};
  glm::dvec3 middle(0.0), facing(0.0), color(0.0);
  for (std::uint32_t k = first; k < first + count; ++k) {
    middle += flux_of(tiles_[k]) * glm::dvec3(middle_of(tiles_[k]));
    facing += double{tiles_[k].brightness} * glm::dvec3(scaled_normal(tiles_[k]));
    color += double{glm::length(scaled_normal(tiles_[k]))} * glm::dvec3(tiles_[k].luminance);
    group.flux += flux_of(tiles_[k]);
    group.two_sided = group.two_sided || tiles_[k].two_sided;
  }
  group.color = Rgb(color / group.flux);
  group.middle = glm::vec3(middle / group.flux);
  group.facing = glm::vec3(facing / group.flux);
  for (std::uint32_t k = first; k < first + count; ++k) {
    for (const glm::vec3& corner : tiles_[k].corner) {
      group.radius = std::max(group.radius, glm::distance(group.middle, corner));
      group.thickness = std::max(group.thickness, std::abs(glm::dot(group.facing, corner - group.middle)));
    }
  }
  return group;
}

double Lamps::weight_of_lamp(std::uint32_t lamp, const SurfacePoint& point) const {
  const EmissiveTile& tile = tiles_[lamp];
  if (in_plane(tile, point.position, surface_offset_)) return 0.0;
  const glm::vec3 apart = middle_of(tile) - point.position;
  const float irradiance = glm::dot(apart, apart) > reach2_[lamp] ? point_like_irradiance(tile, point)
                                                                  : triangle_irradiance(tile.corner, point);
  return double{tile.two_sided ? std::abs(irradiance) : std::max(irradiance, 0.0F)} * double{tile.brightness};
}

Lamps::FarView Lamps::view_from_afar(const Group& group, const SurfacePoint& point) const {
  // All of it below the horizon?
  const glm::vec3 apart = group.middle - point.position;
  const float height = glm::dot(point.normal, apart);
  if (height <= -group.radius) return {FarView::kHidden, 0.0};

  // All in one plane, and the point in it or behind it?
  if (glm::dot(group.facing, group.facing) > kPlane) {
    const float before = -glm::dot(group.facing, apart);
    if (std::abs(before) + group.thickness <= surface_offset_) return {FarView::kHidden, 0.0};
    if (!group.two_sided && before <= -group.thickness) return {FarView::kHidden, 0.0};
  }

  // So far that it counts as one lamp?
  const float distance = glm::length(apart);
  if (!(distance > kFar * group.radius)) return {FarView::kUnclear, 0.0};

  // All of it above the horizon, and seen from the side that shines?
  const float spread = std::sqrt(std::max(0.0F, 1.0F - glm::dot(group.facing, group.facing))) + group.radius / distance;
  const float cosine = -glm::dot(group.facing, apart) / distance;
  if (!group.two_sided && cosine <= -spread) return {FarView::kHidden, 0.0};
  const float there = group.two_sided ? std::abs(cosine) : cosine;
  if (height < group.radius || there < spread) return {FarView::kUnclear, 0.0};
  return {FarView::kInView, group.flux * double{height} * double{there} / (double{distance} * distance * distance)};
}

void Lamps::weigh(const SurfacePoint& point, std::uint32_t deal, LampWeights& weights) const {
  weights.entries.clear();
  weights.total = 0.0;
  const auto add = [&](double weight, std::uint32_t group) {
    if (!(weight > 0.0)) return;
    weights.total += weight;
    weights.entries.push_back({weights.total, group});
  };

  // From the roots down, what is unclear is opened. A tree is not much deeper than the logarithm of its lamps.
  thread_local std::vector<std::uint32_t> open;
  const bool is_last = deal + 1 == deal_count();
  open.assign(roots_.begin() + deal, is_last ? roots_.end() : roots_.begin() + deal + 1);
  while (!open.empty()) {
    const std::uint32_t index = open.back();
    open.pop_back();
    const Group& group = groups_[index];
    if (group.count == 1) {
      add(weight_of_lamp(group.first, point), index);
      continue;
    }
    const FarView view = view_from_afar(group, point);
    if (view.share == FarView::kInView) add(view.weight, index);
    if (view.share != FarView::kUnclear) continue;
    open.push_back(group.second_child);
    open.push_back(index + 1);
  }
}

ChosenLamp Lamps::choose(const LampWeights& weights, double along) const {
  // The group at this place of the sum of weights.
  const double place = along * weights.total;
  const auto entry = std::min(std::lower_bound(weights.entries.begin(), weights.entries.end(), place,
                                               [](const auto& e, double p) { return e.until < p; }),
                              weights.entries.end() - 1);
  const double before = entry == weights.entries.begin() ? 0.0 : (entry - 1)->until;
  const Group& group = groups_[entry->group];
  const Rgb irradiance = group.color * static_cast<float>(weights.total);
  if (group.count == 1) return {group.first, irradiance};

  // Within a group, what is left of the place picks a lamp by flux.
  const auto first = flux_until_.begin() + group.first + 1, last = first + group.count;
  const double share = (place - before) / (entry->until - before);
  const double wanted = *(first - 1) + share * (*(last - 1) - *(first - 1));
  const auto found = std::min(std::lower_bound(first, last, wanted), last - 1);
  return {static_cast<std::uint32_t>(found - flux_until_.begin()) - 1, irradiance};
}

}  // namespace radiosity
