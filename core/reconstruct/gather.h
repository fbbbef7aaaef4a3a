// Light at a point: direct light by shadow rays + one hemicube over the solved patches.
//
// The final gather separates what is displayed from what light was exchanged between: the patches may be coarse, for a
// hemicube averages over thousands of them. Lischinski, Tampieri and Greenberg. Combining Hierarchical Radiosity and
// Discontinuity Meshing. 1993
#pragma once

#include <cstdint>
#include <span>

#include "core/mesh/patches.h"
#include "core/reconstruct/sample_log.h"
#include "core/transport/direct_light.h"
#include "core/transport/sky_parts.h"
#include "core/visibility/hemicube.h"
#include "core/visibility/item_buffer.h"

namespace radiosity {

/// What a point sees.
struct Gathered {
  Rgb irradiance{0.0F};     ///< H, lx
  float back_share = 0.0F;  ///< share of the view filled by backs that send no light, [0,1]
};

/// A sample is buried if backs fill more of its view than this: it lies inside or behind something.
inline constexpr float kBuriedShare = 0.3F;

/// Thread-safe. Everything referred to must outlive it.
struct Gatherer {
  const Scene& scene;
  const Patches& patches;
  const Hemicube& hemicube;
  const ItemBufferMaker& items;
  const DirectLight& direct;
  const SmoothSky& sky;
  std::span<const Rgb> radiosity;   ///< solved, [patch_count], lm/m2
  float offset;                     ///< metres that a hemicube stands off its surface, surface_offset()
  bool sees_sources = true;         ///< whether the sky and what `direct` knows shine on points
  bool shows_reached_side = false;  ///< two-sided surfaces show their back where no light reaches the front
  SampleLog* log = nullptr;         ///< keeps the light of samples by light groups

  /// `index` picks the twist and the place in the low-discrepancy sequences. `seen` is set, if given.
  Gathered at(const SurfacePoint& point, std::uint32_t index, const Seen* seen = nullptr) const;
  /// Whether light reaches the back of a place of a triangle, but not its front.
  bool only_back_is_reached(std::uint32_t triangle, Barycentrics place) const;
  /// at() for a point at `place` of the front of a triangle: with fewer rays where no light arrives.
  Gathered on_front(std::uint32_t triangle, Barycentrics place, const SurfacePoint& point, std::uint32_t index,
                    const Seen* seen = nullptr) const;
};

}  // namespace radiosity
