// What places should show: path-traced luminance with its noise, refined until the noise is as low as wanted.
//
// Samples go where the noise is, in rounds: a place gets paths in proportion to their standard deviation (Neyman),
// which is taken half from the place itself and half from all places together, so that a place whose first paths missed
// a rare bright one is not left alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/progress.h"
#include "core/scene.h"
#include "core/verify/path_tracer.h"

namespace radiosity {

/// A place whose luminance is wanted.
struct ReferencePlace {
  glm::vec3 position{0.0F};  ///< metres, on the surface
  glm::vec3 normal{0.0F};    ///< unit, of the side that is meant
  Rgb reflectance{0.0F};     ///< rho
  Rgb emission{0.0F};        ///< Le, cd/m2
};

struct ReferenceOptions {
  double noise = 0.005;    ///< wanted: root mean variance over mean luminance
  int max_samples = 4096;  ///< paths per place, at least kFirstSamples are traced in any case
  std::uint64_t seed = 1;
};

/// Paths of the first round.
inline constexpr std::uint32_t kFirstSamples = 64;

/// A place is buried if more of its paths than this begin at a back that sends no light: it lies inside something.
inline constexpr double kBuriedPathShare = 0.25;

/// Shapes: per place [places.size()].
struct Reference {
  std::vector<Rgb> luminance;         ///< rho H / pi + Le, cd/m2
  std::vector<double> variance;       ///< of `luminance` as the eye weighs it, (cd/m2)^2: of the mean, not of one path
  std::vector<double> band_variance;  ///< of `luminance`, summed over the three bands, likewise
  std::vector<std::uint8_t> buried;   ///< 1: left out of everything below
  double noise = 0.0;                 ///< reached: root mean variance over mean luminance
  std::uint64_t sample_count = 0;     ///< paths in total
};

/// Parallel; the same result for any number of threads. Throws `Cancelled`.
Reference trace_reference(const PathTracer& tracer, std::span<const ReferencePlace> places,
                          const ReferenceOptions& options, const Progress& progress);

}  // namespace radiosity
