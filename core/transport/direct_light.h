// Direct light at a point: from lamps (emissive tiles) and punctual lights, with shadow rays.
//
// Shadow rays are exact where a hemicube is not: a small lamp covers few cells. What a lamp would bring unoccluded has
// a closed form, so rays decide visibility only. Rays go to the lamps in proportion to what each would bring: evenly
// spaced along the cumulative sum of contributions (systematic sampling), so thousands of lamps cost no more rays than
// one. Sky and the dim remainder of the emission are left to the hemicube (reconstruct/gather.h).
//
// Irradiance from a polygon: Lambert 1760, as in Baum, Rushmeier and Winget 1989.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/patches.h"
#include "core/visibility/occlusion.h"
#include "core/visibility/ray_scene.h"

namespace radiosity {

struct DirectLightOptions {
  int lamp_rays = 128;  ///< shadow rays to all lamps together where some are hidden
  int probe_rays = 32;  ///< how many of these, spread evenly, are sent first: if all agree, the rest are not sent
};

/// Irradiance (lx) that an unoccluded triangle of uniform luminance 1 cd/m2 brings to a point, with what lies below the
/// point's horizon cut off. Corners counter-clockwise seen from the front; negative where the point sees the back.
float triangle_irradiance(const glm::vec3 corner[3], const SurfacePoint& at);

/// Thread-safe. `rays` and `patches` must outlive it.
class DirectLight {
 public:
  DirectLight(const RayScene& rays, const Patches& patches, const DirectLightOptions& options);

  /// Irradiance at a point, lx. `index` picks the point's place in the low-discrepancy sequences.
  Rgb at(const SurfacePoint& point, std::uint32_t index) const;

 private:
  Rgb from_lamps(const SurfacePoint& point, std::uint32_t index) const;
  Rgb from_lights(const SurfacePoint& point, std::uint32_t index) const;

  const RayScene& rays_;
  const Patches& patches_;
  DirectLightOptions options_;
  float offset_;               // m, ends of shadow rays are this far off their surfaces
  std::vector<float> reach2_;  // per lamp: squared distance (m2) beyond which it counts as a point
};

/// Direct light of each patch, the mean over its points: lamps and punctual lights by `direct`, [patch_count], lx.
/// Parallel; throws `Cancelled`.
std::vector<Rgb> direct_on_patches(const DirectLight& direct, const Patches& patches, const Progress& progress);

}  // namespace radiosity
