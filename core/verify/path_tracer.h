// Light at a point by random paths: slow, noisy, and right on the mean. What a bake is compared with.
//
// Shares no code of light transport with the baker: no patches, no hemicubes, no closed forms. Paths scatter by the
// cosine and aim at emitters and punctual lights at every bounce; emitters that they meet by chance count too, each way
// weighted by how likely it was (balance of powers). Russian roulette ends paths without bias.
//
// Kajiya. The Rendering Equation. 1986
// Veach and Guibas. Optimally Combining Sampling Techniques for Monte Carlo Rendering. 1995
#pragma once

#include "core/emitters.h"
#include "core/random.h"
#include "core/scene.h"
#include "core/visibility/ray_scene.h"
#include "core/visibility/single_ray.h"

namespace radiosity {

/// What one path brings.
struct PathSample {
  Rgb irradiance{0.0F};    ///< lx; the mean over many paths is H
  bool sees_back = false;  ///< the path's first hit is a back that sends no light
};

/// Immutable, thread-safe. `rays` must outlive it.
class PathTracer {
 public:
  explicit PathTracer(const RayScene& rays);

  /// Light that arrives at a place of a surface (metres) on the side of `normal` (unit).
  PathSample sample(const glm::vec3& position, const glm::vec3& normal, Random& random) const;

 private:
  struct Place {
    glm::vec3 position{0.0F};  ///< metres, lifted off the surface
    glm::vec3 normal{0.0F};    ///< unit
  };

  Rgb from_emitters(const Place& place, Random& random) const;
  Rgb from_lights(const Place& place, Random& random) const;
  /// What an emitter that the cosine has found shows, weighted.
  Rgb found_emission(const Place& place, const Ray& ray, const Hit& hit) const;
  /// Where a path goes on after a hit.
  Place place_of(const Ray& ray, const Hit& hit) const;

  const RayScene& rays_;
  const Scene& scene_;
  Emitters emitters_;
  float offset_;  ///< metres
};

}  // namespace radiosity
