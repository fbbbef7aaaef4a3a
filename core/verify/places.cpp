#include "core/verify/places.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/emitters.h"
#include "core/random.h"
#include "core/visibility/single_ray.h"

namespace radiosity {
namespace {

/// How far apart the two scenes may be, in surface offsets: coordinates may have been stored in 16 bits.
constexpr float kReachInOffsets = 40.0F;

/// Cosine of the largest angle between triangles that face the same way.
constexpr float kSameFacing = 0.5F;

glm::vec3 corner(const Scene& scene, std::uint32_t triangle, int k) {
  return scene.positions[scene.triangles[triangle][k]];
}

/// The point of a triangle nearest to `p`.
///
/// Ericson. Real-Time Collision Detection. 2005, section 5.1.5: the region of the plane that `p` lies over.
Barycentrics nearest_place(const Scene& scene, std::uint32_t triangle, const glm::vec3& p) {
  const glm::vec3 a = corner(scene, triangle, 0), b = corner(scene, triangle, 1), c = corner(scene, triangle, 2);
  const glm::vec3 ab = b - a, ac = c - a;
  const float ab_a = glm::dot(ab, p - a), ac_a = glm::dot(ac, p - a);
  const float ab_b = glm::dot(ab, p - b), ac_b = glm::dot(ac, p - b);
  const float ab_c = glm::dot(ab, p - c), ac_c = glm::dot(ac, p - c);

  // Over a corner.
  if (ab_a <= 0.0F && ac_a <= 0.0F) return {0.0F, 0.0F};
  if (ab_b >= 0.0F && ac_b <= ab_b) return {1.0F, 0.0F};
  if (ac_c >= 0.0F && ab_c <= ac_c) return {0.0F, 1.0F};

  // Over an edge.
  const float weight_c = ab_a * ac_b - ab_b * ac_a;
  if (weight_c <= 0.0F && ab_a >= 0.0F && ab_b <= 0.0F) return {ab_a / (ab_a - ab_b), 0.0F};
  const float weight_b = ab_c * ac_a - ab_a * ac_c;
  if (weight_b <= 0.0F && ac_a >= 0.0F && ac_c <= 0.0F) return {0.0F, ac_a / (ac_a - ac_c)};
  const float weight_a = ab_b * ac_c - ab_c * ac_b;
  const float towards_c = ac_b - ab_b, towards_b = ab_c - ac_c;
  if (weight_a <= 0.0F && towards_c >= 0.0F && towards_b >= 0.0F) {
    const float share = towards_c / (towards_c + towards_b);
    return {1.0F - share, share};
  }

  // Over the inside.
  return Barycentrics(weight_b, weight_c) / (weight_a + weight_b + weight_c);
}

}  // namespace

std::vector<SurfacePlace> random_places(const Scene& scene, std::span<const std::uint8_t> wanted, int count,
                                        std::uint64_t seed) {
  // The area up to and with each triangle.
  std::vector<double> cumulative_area;
  double area = 0.0;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    if (wanted[t] != 0) area += 0.5 * static_cast<double>(glm::length(scaled_normal(scene, t)));
    cumulative_area.push_back(area);
  }
  if (!(area > 0.0)) return {};

  // One place in each of `count` equal parts of it.
  std::vector<SurfacePlace> places;
  for (int i = 0; i < count; ++i) {
    Random random(seed, static_cast<std::uint64_t>(i));
    const double at = (i + static_cast<double>(random.share())) / count * area;
    const auto found = std::upper_bound(cumulative_area.begin(), cumulative_area.end() - 1, at);
    const auto triangle = static_cast<std::uint32_t>(found - cumulative_area.begin());
    if (wanted[triangle] != 0) places.push_back({triangle, random_place(random)});
  }
  return places;
}

PlaceFinder::PlaceFinder(const RayScene& rays) : rays_(rays), offset_(surface_offset(rays.scene())) {}

std::optional<SurfacePlace> PlaceFinder::find(const glm::vec3& position, const glm::vec3& normal,
                                              const Preference& preference) const {
  const Scene& scene = rays_.scene();
  const float reach = kReachInOffsets * offset_;
  std::optional<SurfacePlace> best;
  float best_distance = 0.0F;
  int best_preference = 0;
  for (const std::uint32_t triangle : triangles_near(rays_, position, reach)) {
    // Facing the same way, and near.
    const glm::vec3 scaled = scaled_normal(scene, triangle);
    const float double_area = glm::length(scaled);
    if (!(double_area > 0.0F) || glm::dot(scaled, normal) <= kSameFacing * double_area) continue;
    const int preferred = preference(triangle);
    if (preferred < 0) continue;
    const Barycentrics at = nearest_place(scene, triangle, position);
    const float distance = glm::distance(point_at(scene, triangle, at), position);
    if (distance > reach) continue;

    // Distances that differ by less than the offset are one.
    const bool nearer = !best || distance < best_distance - offset_;
    const bool as_near = best && distance < best_distance + offset_;
    const bool better = preferred > best_preference || (preferred == best_preference && distance < best_distance);
    if (!nearer && !(as_near && better)) continue;
    best = SurfacePlace{triangle, at};
    best_distance = distance;
    best_preference = preferred;
  }
  return best;
}

glm::vec3 shading_normal(const Scene& scene, const SurfacePlace& place) {
  const glm::vec3 flat = glm::normalize(scaled_normal(scene, place.triangle));
  const float weight[3] = {1.0F - place.at.x - place.at.y, place.at.x, place.at.y};
  glm::vec3 sum(0.0F);
  for (int k = 0; k < 3; ++k) {
    const glm::vec3& normal = scene.normals[scene.triangles[place.triangle][k]];
    sum += weight[k] * (glm::dot(normal, flat) > 0.0F ? normal : flat);
  }
  return glm::normalize(sum);
}

}  // namespace radiosity
