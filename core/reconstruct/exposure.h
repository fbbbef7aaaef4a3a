// Luminance -> linear colour in [0,1].
//
// COLOR_0 cannot hold more than 1, so the light is scaled by an exposure k: colour = k * luminance. There is no tone
// curve: engines apply their own.
#pragma once

#include <span>

#include "core/scene.h"

namespace radiosity {

/// One vertex's share of what a camera sees.
struct ExposureSample {
  Rgb luminance{0.0F};  ///< what is displayed, rho H / pi + Le, cd/m2
  float area = 0.0F;    ///< surface that this vertex stands for, m2
  bool lamp = false;    ///< emits by itself: may clip, does not count for automatic exposure
};

/// The exposure k (m2/cd) that suits the samples: 1 if the area-weighted 99th percentile of the brightest band of what
/// is not a lamp lies in [0.25, 1], otherwise 0.9 over that percentile. 1 if there is no light.
float automatic_exposure(std::span<const ExposureSample> samples);

/// Exposure for a camera's EV100: 1 / (1.2 * 2^ev100), m2/cd.
float exposure_from_ev100(float ev100);

/// Share of the area, lamps included, whose colour at exposure `k` exceeds 1 in some band, [0,1].
float clipped_share(std::span<const ExposureSample> samples, float k);

}  // namespace radiosity
