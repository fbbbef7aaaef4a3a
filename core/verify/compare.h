// How far what is shown is from what should be shown, in a few numbers.
#pragma once

#include <span>

#include "core/scene.h"

namespace radiosity {

/// One place.
struct ComparedPlace {
  Rgb reference{0.0F};         ///< luminance that it should show, cd/m2
  Rgb displayed{0.0F};         ///< linear colour that it does show
  bool clipped = false;        ///< the colour was cut off at white
  double variance = 0.0;       ///< of the reference's luminance, (cd/m2)^2
  double band_variance = 0.0;  ///< of the reference, summed over the three bands, (cd/m2)^2
};

/// Errors are those of displayed / exposure against the reference, in luminance as the eye weighs it. A reference at a
/// clipped place is clipped too: what white cannot show is no error.
struct Comparison {
  double exposure = 1.0;         ///< k, m2/cd
  double mean = 0.0;             ///< of the reference, cd/m2
  double relative_rmse = 0.0;    ///< root mean square error over `mean`, the reference's noise taken out
  double reference_noise = 0.0;  ///< root mean variance over `mean`
  double median = 0.0;           ///< of |error| / (value + 0.1 mean)
  double p95 = 0.0, p99 = 0.0;   ///< 95 and 99 % of the places are better than this, likewise
  double clipped_share = 0.0;
};

/// The exposure that fits best: least squares over the places that are not clipped, without the bias that the
/// reference's noise has on them; 1 where all are clipped, or all are black.
double fitted_exposure(std::span<const ComparedPlace> places);

/// Compares under `exposure`, m2/cd. REQUIRES: there are places, and exposure > 0.
Comparison compare(std::span<const ComparedPlace> places, double exposure);

/// Signed error of a place as in Comparison::median: above 0 where it is too bright. `mean` in cd/m2.
double relative_error(const ComparedPlace& place, double exposure, double mean);

}  // namespace radiosity
