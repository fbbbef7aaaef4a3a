// Which elements the fit cannot represent, and how wrong the whole is.
//
// Samples are compared with what the display mesh shows where they lie. A sample that took part in a fit is closer to
// it than any other place is; how much closer follows from its leverage, the share that it has in the fit at its own
// place: the residual without it would be 1 / (1 - leverage) times as large. And a sample is not the truth either: its
// noise, found by looking twice from some of the places, is no error of the fit.
//
// Allen. The Relationship Between Variable Selection and Data Augmentation and a Method for Prediction. 1974
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/refined_mesh.h"
#include "core/reconstruct/samples.h"
#include "core/scene.h"

namespace radiosity {

/// In which space elements are ranked.
enum class ErrorSpace : std::uint8_t {
  kDisplay,  ///< as an eye that is adapted to the mean sees it: a step in the dark counts more than in the light
  kLinear    ///< luminance
};

struct MisfitOptions {
  ErrorSpace space = ErrorSpace::kDisplay;
  float exposure = 0.0F;  ///< k, m2/cd, at which light is cut off at white; 0 chooses as automatic_exposure() does
  double variance = 0.0;  ///< of samples, see sample_variance(): taken out of the estimate
};

struct Misfit {
  std::vector<double> of_element;  ///< area x mean squared residual, in the space asked for, [element_count]
  double relative_rmse = 0.0;      ///< estimate of the root mean square error of luminance over its mean
};

/// The misfit of `irradiance` (at the vertices, lx). What is white at all corners of an element hides its error.
/// Parallel; deterministic.
Misfit measure_misfit(const Scene& scene, const RefinedMesh& mesh, const Samples& samples,
                      std::span<const Rgb> irradiance, const MisfitOptions& options);

/// Variance of what a sample shows about what its place shows, (cd/m2)^2: the mean over the surface of half the squared
/// difference, in luminance, to `count` samples that are taken again. Parallel; throws `Cancelled`.
double sample_variance(const RefinedMesh& mesh, const Samples& samples, const Gatherer& gatherer, std::size_t count,
                       const Progress& progress);

/// What to cut next: of those elements that `may_be_cut` [element_count], worst first, as many as have half of all
/// their misfit, but an eighth of all elements at most and a 64th at least.
std::vector<std::uint32_t> worst_elements(const Misfit& misfit, std::span<const std::uint8_t> may_be_cut);

}  // namespace radiosity
