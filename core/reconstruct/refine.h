// Which elements the fit cannot represent, and how wrong the whole is.
//
// Elements are ranked by how far the samples in them are from what the display mesh shows there. That is no measure of
// the error: samples are noisy, those that took part in a fit are closer to it than other places are, and elements that
// were lucky with their samples are not cut. So the error is checked at places of its own, each of which is looked at
// from twice: the noise of both looks is independent, and the mean product of both differences from what is shown is
// the mean square of the error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/refined_mesh.h"
#include "core/reconstruct/samples.h"
#include "core/reconstruct/shown_light.h"
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
  std::size_t places_to_check = 400;  ///< for check_error(), >= 1
};

/// Luminance in cd/m2. What is white at all corners of an element hides its error.
struct Misfit {
  std::vector<double> squared;     ///< area x mean squared residual of the samples, [element_count]
  std::vector<double> of_element;  ///< the same in the space asked for
  double mean = 0.0;               ///< over the surface that has samples
  ShownLight shown;                ///< what elements are made of
  Rgb white{0.0F};                 ///< what is brighter shows as this, cd/m2
};

/// The misfit of `irradiance` (at the vertices, lx). Parallel; deterministic.
Misfit measure_misfit(const Scene& scene, const RefinedMesh& mesh, const Samples& samples,
                      std::span<const Rgb> irradiance, const MisfitOptions& options);

/// Root mean square of a difference, over mean luminance.
struct ErrorEstimate {
  double error = 0.0;
  double noise = 0.0;  ///< an error that the places looked at could not tell from none

  bool is_surely_below(double wanted) const { return error <= wanted && noise <= wanted; }
};

/// How wrong the whole is, by so many places, more of them where `misfit`, that of the same mesh and light, is larger.
/// Parallel; throws `Cancelled`.
ErrorEstimate check_error(const RefinedMesh& mesh, const Samples& samples, std::span<const Rgb> irradiance,
                          const Misfit& misfit, const Gatherer& gatherer, const MisfitOptions& options,
                          const Progress& progress);

/// What to cut next: of those elements that `may_be_cut` [element_count], worst first, as many as have half of all
/// their misfit, but `least` at least and an eighth of all elements at most.
std::vector<std::uint32_t> worst_elements(const Misfit& misfit, std::span<const std::uint8_t> may_be_cut,
                                          std::size_t least);

}  // namespace radiosity
