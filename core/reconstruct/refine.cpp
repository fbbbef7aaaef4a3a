#include "core/reconstruct/refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "core/parallel.h"

namespace radiosity {
namespace {

/// What is cut in one round: the more at once, the more is cut that would have come right by itself.
constexpr double kShareOfMisfit = 0.5;
constexpr std::size_t kMostShare = 8;  ///< one in this many elements

bool has_samples(const Samples& samples, std::uint32_t e) {
  return samples.first_of_element[e + 1] > samples.first_of_element[e];
}

/// What an element shows, and what of the truth it could show.
struct ElementView {
  glm::vec3 at_corners{0.0F};  ///< luminance, cd/m2
  Rgb most{std::numeric_limits<float>::max()};

  /// Displayed less true luminance where the corners have these weights and `light` is what should be shown.
  double residual(const glm::vec3& weights, const Rgb& light) const {
    return double{glm::dot(weights, at_corners)} - double{luminance_of(glm::min(light, most))};
  }
};

ElementView view_of(std::uint32_t e, const RefinedMesh& mesh, std::span<const Rgb> irradiance, const Misfit& misfit) {
  ElementView view;
  Rgb least = view.most;
  for (int k = 0; k < 3; ++k) {
    const Rgb light = misfit.shown.under(e, irradiance[mesh.elements[e][k]]);
    view.at_corners[k] = luminance_of(glm::min(light, misfit.white));
    least = glm::min(least, light);
  }
  for (int band = 0; band < 3; ++band) {
    if (least[band] >= misfit.white[band]) view.most[band] = misfit.white[band];
  }
  return view;
}

/// Brighter than this is white, cd/m2.
Rgb white_of(const RefinedMesh& mesh, const Samples& samples, const ShownLight& shown, float exposure) {
  return Rgb(1.0F / (exposure > 0.0F ? exposure : exposure_of(mesh, samples, shown)));
}

/// A place where the error is checked.
struct Check {
  std::uint32_t element = 0;
  double weight = 0.0;  ///< the surface that it stands for, m2, but for a factor common to all
};

/// Half of them spread by area, half by misfit.
std::vector<Check> places_to_check(const RefinedMesh& mesh, const Samples& samples, const Misfit& misfit,
                                   std::size_t count) {
  double area = 0.0, squared = 0.0;
  for (std::uint32_t e = 0; e < misfit.squared.size(); ++e) {
    if (has_samples(samples, e)) area += double{element_area(mesh, e)};
    squared += misfit.squared[e];
  }
  std::vector<Check> checks;
  double due = 0.5;
  for (std::uint32_t e = 0; e < misfit.squared.size(); ++e) {
    if (!has_samples(samples, e)) continue;
    const double by_area = double{element_area(mesh, e)} / area;
    const double share = squared > 0.0 ? 0.5 * by_area + 0.5 * misfit.squared[e] / squared : by_area;
    due += static_cast<double>(count) * share;
    for (; due >= 1.0; due -= 1.0) checks.push_back({e, by_area / share});
  }
  return checks;
}

}  // namespace

Misfit measure_misfit(const Scene& scene, const RefinedMesh& mesh, const Samples& samples,
                      std::span<const Rgb> irradiance, const MisfitOptions& options) {
  // Each element by itself.
  const std::size_t element_count = mesh.elements.size();
  std::vector<double> value(element_count, 0.0), area(element_count, 0.0);
  Misfit misfit;
  misfit.squared.assign(element_count, 0.0);
  misfit.of_element.assign(element_count, 0.0);
  misfit.shown = shown_light(scene, mesh);
  misfit.white = white_of(mesh, samples, misfit.shown, options.exposure);
  parallel_in_chunks(element_count, element_count, {}, "", [&](std::size_t element) {
    const auto e = static_cast<std::uint32_t>(element);
    if (!has_samples(samples, e)) return;
    const ElementView view = view_of(e, mesh, irradiance, misfit);
    const std::uint32_t first = samples.first_of_element[e], last = samples.first_of_element[e + 1];
    const double count = last - first;
    area[e] = double{element_area(mesh, e)};
    for (std::uint32_t s = first; s < last; ++s) {
      const Rgb light = misfit.shown.under(e, samples.irradiance[s]);
      const double residual = view.residual(samples.weights[s], light);
      misfit.squared[e] += area[e] * residual * residual / count;
      value[e] += double{luminance_of(glm::min(light, view.most))} / count;
    }
  });

  // The whole.
  double total = 0.0, total_area = 0.0;
  for (std::size_t e = 0; e < element_count; ++e) {
    total += area[e] * value[e];
    total_area += area[e];
  }
  if (!(total > 0.0)) return misfit;
  misfit.mean = total / total_area;

  for (std::size_t e = 0; e < element_count; ++e) {
    const bool linear = options.space == ErrorSpace::kLinear;
    misfit.of_element[e] = misfit.squared[e] * (linear ? 1.0 : 2.0 * misfit.mean / (misfit.mean + value[e]));
  }
  return misfit;
}

ErrorEstimate check_error(const RefinedMesh& mesh, const Samples& samples, std::span<const Rgb> irradiance,
                          const Misfit& misfit, const Gatherer& gatherer, const MisfitOptions& options,
                          const Progress& progress) {
  // Two looks from each place.
  const std::vector<Check> checks = places_to_check(mesh, samples, misfit, options.places_to_check);
  std::vector<double> product(checks.size(), 0.0), weight(checks.size(), 0.0);
  parallel_in_chunks(checks.size(), 256, progress, "check", [&](std::size_t k) {
    const std::uint32_t e = checks[k].element;
    const ElementView view = view_of(e, mesh, irradiance, misfit);
    const auto number = samples.taken + 2 * static_cast<std::uint32_t>(k);
    const glm::vec3 weights = corner_weights(number);
    std::array<double, 2> residual{};
    for (std::uint32_t look = 0; look < 2; ++look) {
      const Gathered gathered = gather_sample(mesh, gatherer, e, number + look, weights);
      if (gathered.back_share > kBuriedShare) return;
      residual[look] = view.residual(weights, misfit.shown.under(e, gathered.irradiance));
    }
    product[k] = checks[k].weight * residual[0] * residual[1];
    weight[k] = checks[k].weight;
  });

  // The mean of the products, and its standard error.
  const double total = std::accumulate(weight.begin(), weight.end(), 0.0);
  if (!(total > 0.0 && misfit.mean > 0.0)) return {};
  const double squared = std::accumulate(product.begin(), product.end(), 0.0) / total;
  double scatter = 0.0;
  for (std::size_t k = 0; k < checks.size(); ++k) {
    const double off = product[k] - weight[k] * squared;
    scatter += off * off;
  }
  return {std::sqrt(std::max(0.0, squared)) / misfit.mean, std::sqrt(std::sqrt(scatter) / total) / misfit.mean};
}

std::vector<std::uint32_t> worst_elements(const Misfit& misfit, std::span<const std::uint8_t> may_be_cut,
                                          std::size_t least) {
  std::vector<std::uint32_t> elements;
  double left = 0.0;
  for (std::uint32_t e = 0; e < misfit.of_element.size(); ++e) {
    if (may_be_cut[e] == 0 || !(misfit.of_element[e] > 0.0)) continue;
    elements.push_back(e);
    left += kShareOfMisfit * misfit.of_element[e];
  }
  const auto is_worse = [&misfit](std::uint32_t a, std::uint32_t b) {
    return misfit.of_element[a] != misfit.of_element[b] ? misfit.of_element[a] > misfit.of_element[b] : a < b;
  };
  const std::size_t count = misfit.of_element.size();
  const std::size_t most = std::min(count / kMostShare + 1, elements.size());
  std::partial_sort(elements.begin(), elements.begin() + static_cast<std::ptrdiff_t>(most), elements.end(), is_worse);
  std::size_t taken = 0;
  for (; taken < most && (left > 0.0 || taken < least); ++taken) {
    left -= misfit.of_element[elements[taken]];
  }
  elements.resize(taken);
  return elements;
}

}  // namespace radiosity
