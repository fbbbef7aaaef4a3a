// Is the segment between two points free?
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/visibility/ray_scene.h"

namespace radiosity {

/// One shadow ray. Ends are in metres and already lifted off their surfaces; for a light at infinity `to_target` is the
/// unit direction towards it and `distance` is infinite.
struct ShadowRay {
  glm::vec3 from{0.0F};
  glm::vec3 to_target{0.0F};  ///< unit
  float distance = 0.0F;      ///< metres
  float threshold = 0.0F;     ///< opacity a see-through surface needs to block this ray, [0,1) (scene.h, lets_through)
};

/// Whether anything blocks each ray: `blocked` is [rays.size()], 1 where something does. Thread-safe.
void trace_shadow_rays(const RayScene& scene, std::span<const ShadowRay> rays, std::span<std::uint8_t> blocked);

}  // namespace radiosity
