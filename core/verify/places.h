// Where a bake is verified: random places on its surfaces, and the same places in the scene that was baked.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/scene.h"
#include "core/visibility/ray_scene.h"

namespace radiosity {

/// A place on a surface.
struct SurfacePlace {
  std::uint32_t triangle = kNothing;
  Barycentrics at{0.0F};
};

/// `count` random places on the triangles that are `wanted` ([triangle_count], 1 or 0): stratified, one in each of
/// `count` equal parts of their area. Empty if they have no area.
std::vector<SurfacePlace> random_places(const Scene& scene, std::span<const std::uint8_t> wanted, int count,
                                        std::uint64_t seed);

/// Finds a place of one scene again in another of the same shape. Thread-safe.
class PlaceFinder {
 public:
  /// Says how well a triangle of the scene searched suits, where several coincide: the highest answer wins; below 0
  /// means not at all.
  using Preference = std::function<int(std::uint32_t triangle)>;

  /// `rays` must outlive it.
  explicit PlaceFinder(const RayScene& rays);

  /// The nearest place within a small distance of `position` (metres) on a triangle that faces the way of `normal`
  /// (unit, geometric), or nothing.
  std::optional<SurfacePlace> find(const glm::vec3& position, const glm::vec3& normal,
                                   const Preference& preference) const;

 private:
  const RayScene& rays_;
  float offset_;  ///< metres
};

/// The normal that a place is shaded with, unit, on the front: interpolated from the corners. Corners without a normal,
/// or whose normal points to the other side, count as flat. REQUIRES: the triangle has area.
glm::vec3 shading_normal(const Scene& scene, const SurfacePlace& place);

}  // namespace radiosity
