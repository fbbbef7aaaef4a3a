// One ray at a time: what does it meet first, and does it meet anything?
//
// For paths that scatter in all directions. Many rays that belong together are faster as an item buffer (item_buffer.h)
// or as a batch of shadow rays (occlusion.h).
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "core/visibility/ray_scene.h"

namespace radiosity {

/// A ray that starts at `from`, which is already lifted off its surface, and ends `length` metres later.
struct Ray {
  glm::vec3 from{0.0F};                                   ///< metres
  glm::vec3 direction{0.0F};                              ///< unit
  float length = std::numeric_limits<float>::infinity();  ///< metres
};

/// Where a ray meets a triangle.
struct Hit {
  std::uint32_t triangle = kNothing;
  Barycentrics at{0.0F};
  float distance = 0.0F;  ///< metres from the start of the ray
  bool back = false;      ///< the ray meets the back of the triangle
};

/// The opacity that the next see-through triangle must have to stop the ray (scene.h, lets_through). Asked again for
/// each triangle that the ray meets, in no particular order: random answers make layers stop rays independently.
using DrawThreshold = std::function<float()>;

/// The nearest triangle that stops the ray, or nothing. Thread-safe as far as `threshold` is.
std::optional<Hit> nearest_hit(const RayScene& scene, const Ray& ray, const DrawThreshold& threshold);

/// Whether anything stops the ray. Thread-safe as far as `threshold` is.
bool is_blocked(const RayScene& scene, const Ray& ray, const DrawThreshold& threshold);

/// The triangles whose bounding boxes come within `radius` metres of `position`, in ascending order. Opaque or not, and
/// those that coincide too. Thread-safe.
std::vector<std::uint32_t> triangles_near(const RayScene& scene, const glm::vec3& position, float radius);

}  // namespace radiosity
