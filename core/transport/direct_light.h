// Direct light at a point: from lamps (emissive tiles), punctual lights and the bright part of the sky, by shadow rays.
//
// Shadow rays are exact where a hemicube is not: a small lamp covers few cells. What a lamp would bring unoccluded has
// a closed form (lamps.h), so rays decide visibility only. They go to places evenly spaced along the sum of what the
// lamps would bring (systematic sampling). The smooth part of the sky (sky_parts.h) and the dim remainder of the
// emission are left to the hemicube (reconstruct/gather.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/patches.h"
#include "core/transport/lamps.h"
#include "core/transport/sky_parts.h"
#include "core/visibility/occlusion.h"
#include "core/visibility/ray_scene.h"

namespace radiosity {

struct DirectLightOptions {
  int lamp_rays = 128;  ///< shadow rays to all lamps together where some are hidden, and as many to a bright sky
  int probe_rays = 32;  ///< how many of these, spread evenly, are sent first: if all agree, the rest are not sent
};

/// Thread-safe. `rays` and `patches` must outlive it.
class DirectLight {
 public:
  DirectLight(const RayScene& rays, const Patches& patches, const DirectLightOptions& options);

  /// Irradiance at a point, lx. `index` picks the point's place in the low-discrepancy sequences. To `by_group`
  /// [light_group_count()], unless it is empty, the light of each group is added, before it is dimmed.
  Rgb at(const SurfacePoint& point, std::uint32_t index, std::span<Rgb> by_group = {}) const;

 private:
  struct Scratch;

  void trace_lamps(const SurfacePoint& point, std::uint32_t index, std::uint32_t deal, Scratch& scratch) const;
  void trace_lights(const SurfacePoint& point, std::uint32_t index, Scratch& scratch) const;
  void trace_sky(const SurfacePoint& point, std::uint32_t index, Scratch& scratch) const;
  Rgb sum_of_free(const Scratch& scratch, std::span<Rgb> by_group) const;

  const RayScene& rays_;
  Lamps lamps_;
  BrightSky bright_sky_;
  DirectLightOptions options_;
  int rays_to_each_light_;
  float offset_;  // m, ends of shadow rays are this far off their surfaces
};

/// Direct light of each patch, the mean over its points: lamps and punctual lights by `direct`, [patch_count], lx.
/// `by_group` [patch_count * light_group_count()], unless it is empty, is set to that of each group, before it is
/// dimmed. Parallel; throws `Cancelled`.
std::vector<Rgb> direct_on_patches(const DirectLight& direct, const Patches& patches, const Progress& progress,
                                   std::span<Rgb> by_group = {});

}  // namespace radiosity
