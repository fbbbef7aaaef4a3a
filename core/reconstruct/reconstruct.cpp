#include "core/reconstruct/reconstruct.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/reconstruct/interpolate_vertices.h"

namespace radiosity {
namespace {

/// A mesh that is cut where the fit misses the samples needs less smoothness: with 0.02 everywhere the Cornell box was
/// 3.9 % wrong with 450 vertices, so 2.9 %. A uniform one swings more beside shadows without it.
constexpr FitOptions kAdaptiveFit = {.damping = 0.01, .fades = true};

std::vector<Rgb> fit(const DisplayMesh& display, const Samples& samples, Fit fit, std::span<const Rgb> guess) {
  if (fit == Fit::kInterpolate) return interpolate_vertices(display.mesh(), mean_of_samples(samples));
  return fit_vertices(display.mesh(), samples, fit_options(display), guess);
}

/// Where the error is checked between rounds, and where before refinement ends: the check that finds it low enough is
/// more often than not one that was lucky.
constexpr std::size_t kPlaces = 400, kPlacesInTheEnd = 1600;

/// Checks are dear: the next one comes when the mesh may have become good enough. Errors go down with the square root
/// of the elements or faster.
std::size_t elements_at_next_check(std::size_t element_count, double error, double wanted) {
  return static_cast<std::size_t>(static_cast<double>(element_count) *
                                  std::clamp(std::pow(error / wanted, 1.5), 1.1, 2.0));
}

/// Part of the error that is allowed goes to the transport of light, which no sample can see.
double error_left_to_mesh(double max_error) {
  const double of_transport = std::min(0.005, 0.5 * max_error);
  return std::sqrt(max_error * max_error - of_transport * of_transport);
}

/// A round cuts one in this many elements at least, or of the vertices that may be added to the scene's: few rounds are
/// cheap, but what is spent by then cannot go where the misfit is.
constexpr std::size_t kRounds = 64;

/// What the next round of refinement is to cut.
std::vector<std::uint32_t> next_to_cut(const DisplayMesh& display, const Misfit& misfit) {
  if (!display.bisector || display.bisector->reached_limit()) return {};
  const Bisector& bisector = *display.bisector;
  std::vector<std::uint8_t> may_be_cut(misfit.of_element.size());
  for (std::uint32_t e = 0; e < may_be_cut.size(); ++e) may_be_cut[e] = bisector.can_be_bisected(e) ? 1 : 0;
  const std::size_t of_scene = display.mesh().scene_vertex_count;
  const std::size_t budget = std::max(bisector.max_vertices(), of_scene) - of_scene;
  return worst_elements(misfit, may_be_cut, std::min(may_be_cut.size(), budget) / kRounds + 1);
}

/// Why there is no further round; kNotAdaptive if there is one.
RefineEnd end_of(const DisplayMesh& display, bool is_good_enough, bool nothing_to_cut) {
  if (is_good_enough) return RefineEnd::kError;
  if (!nothing_to_cut) return RefineEnd::kNotAdaptive;
  return display.bisector->reached_limit() ? RefineEnd::kLimit : RefineEnd::kFloor;
}

}  // namespace

FitOptions fit_options(const DisplayMesh& display) { return display.bisector ? kAdaptiveFit : FitOptions{}; }

Reconstruction reconstruct(DisplayMesh& display, const Gatherer& gatherer, Fit how, const RefineOptions& adapt,
                           const Progress& progress) {
  Reconstruction light;
  const RefinedMesh& mesh = display.mesh();
  light.samples = gather_samples(mesh, gatherer, {}, progress);
  Pace pace(progress);
  progress.update("fit", 0.0);
  light.irradiance = fit(display, light.samples, how, {});
  progress.update("fit", 1.0);

  const Progress only_cancelled{nullptr, progress.cancelled};
  const MisfitOptions as_seen{adapt.space, adapt.exposure};
  const double max_error = error_left_to_mesh(adapt.max_error);
  ErrorEstimate estimate;
  for (std::size_t check_at = 0;; ++light.rounds) {
    // How good it is, and whether to go on.
    const Misfit misfit = measure_misfit(gatherer.scene, mesh, light.samples, light.irradiance, as_seen);
    const std::vector<std::uint32_t> to_cut = next_to_cut(display, misfit);
    const bool is_checked = to_cut.empty() || mesh.elements.size() >= check_at;
    if (is_checked) {
      const auto check = [&](std::size_t place_count) {
        MisfitOptions options = as_seen;
        options.places_to_check = place_count;
        return check_error(mesh, light.samples, light.irradiance, misfit, gatherer, options, only_cancelled);
      };
      if (!to_cut.empty()) estimate = check(kPlaces);
      if (to_cut.empty() || estimate.is_surely_below(max_error)) estimate = check(kPlacesInTheEnd);
      light.estimated_error = estimate.error;
      check_at = elements_at_next_check(mesh.elements.size(), std::max(estimate.error, estimate.noise), max_error);
    }
    if (!display.bisector) return light;
    light.end = end_of(display, is_checked && estimate.is_surely_below(max_error), to_cut.empty());
    if (light.end == RefineEnd::kNotAdaptive && !pace.allows_another_step()) light.end = RefineEnd::kTime;
    if (light.end != RefineEnd::kNotAdaptive) return light;

    // Cut, sample, fit.
    progress.update("refine", std::min(1.0, max_error / std::max({max_error, estimate.error, estimate.noise})));
    const std::vector<std::uint32_t> origin_of_element = display.bisector->bisect(to_cut);
    append_cuts(mesh, light.irradiance);
    light.samples = samples_after_cuts(light.samples, mesh, origin_of_element, gatherer, {}, only_cancelled);
    light.irradiance = fit(display, light.samples, how, light.irradiance);
  }
}

}  // namespace radiosity
