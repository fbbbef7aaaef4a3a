// From where a picture of the error is taken.
#pragma once

#include <functional>
#include <optional>

#include "core/visibility/ray_scene.h"
#include "core/visibility/single_ray.h"

namespace radiosity {

/// A pinhole camera.
struct Camera {
  glm::vec3 eye{0.0F};                   ///< metres
  glm::vec3 forward{0.0F, 0.0F, -1.0F};  ///< unit
  glm::vec3 right{1.0F, 0.0F, 0.0F};     ///< as long as half the picture is wide at distance 1
  glm::vec3 up{0.0F, 1.0F, 0.0F};        ///< as long as half the picture is high at distance 1

  /// The ray through a point of the picture: x from -1 (left) to 1, y from -1 (below) to 1.
  Ray ray(float x, float y) const;
};

struct View {
  glm::vec3 eye{0.0F};  ///< metres
  glm::vec3 at{0.0F};   ///< metres, in the middle of the picture
};

/// REQUIRES: eye and at differ, fov_degrees in (0, 180) from top to bottom, aspect (width over height) above 0.
Camera make_camera(const View& view, float fov_degrees, float aspect);

/// A view that shows much of the scene: from outside, on the diagonal of the bounding box; from inside if walls that
/// are seen from both sides close it off.
View default_view(const RayScene& rays);

/// The first triangle on the ray that is seen: backs of single-sided ones are not, and the ray goes on `step` metres
/// behind them, surface_offset().
std::optional<Hit> nearest_seen(const RayScene& rays, Ray ray, float step, const DrawThreshold& threshold);

}  // namespace radiosity
