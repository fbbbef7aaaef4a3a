#include "core/reconstruct/refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "core/parallel.h"
#include "core/reconstruct/shown_light.h"
#include "core/reconstruct/smooth_groups.h"

namespace radiosity {
namespace {

/// No sample counts as if it had more of the fit at its place for itself.
constexpr double kMostLeverage = 0.75;

/// What is cut in one round: the more at once, the more is cut that would have come right by itself.
constexpr double kShareOfMisfit = 0.5;
constexpr std::size_t kMostShare = 8, kLeastShare = 64;  ///< one in this many elements

bool has_samples(const Samples& samples, std::uint32_t e) {
  return samples.first_of_element[e + 1] > samples.first_of_element[e];
}

/// How many of the fit's unknowns fall to each element: each vertex is dealt to the elements around it, by area.
std::vector<double> unknowns_per_element(const RefinedMesh& mesh, const Samples& samples) {
  const SmoothGroups groups = find_smooth_groups(mesh);
  std::vector<double> area(mesh.elements.size(), 0.0), area_around(groups.group_count, 0.0);
  for (std::uint32_t e = 0; e < area.size(); ++e) {
    if (!has_samples(samples, e)) continue;
    area[e] = double{element_area(mesh, e)};
    for (int k = 0; k < 3; ++k) area_around[groups.group_of_vertex[mesh.elements[e][k]]] += area[e];
  }
  std::vector<double> unknowns(area.size(), 0.0);
  for (std::uint32_t e = 0; e < area.size(); ++e) {
    if (!(area[e] > 0.0)) continue;
    for (int k = 0; k < 3; ++k) unknowns[e] += area[e] / area_around[groups.group_of_vertex[mesh.elements[e][k]]];
  }
  return unknowns;
}

/// What one element adds to the misfit of the whole.
struct Share {
  double squared = 0.0;  ///< mean squared residual, (cd/m2)^2
  double value = 0.0;    ///< mean luminance, cd/m2
};

Share share_of(std::uint32_t e, const RefinedMesh& mesh, const Samples& samples, std::span<const Rgb> irradiance,
               const ShownLight& shown, const Rgb& white) {
  // What the corners show, and what hides what is brighter: bands that are white at all of them.
  glm::vec3 at_corners;
  Rgb least(std::numeric_limits<float>::max());
  for (int k = 0; k < 3; ++k) {
    const Rgb light = shown.under(e, irradiance[mesh.elements[e][k]]);
    at_corners[k] = luminance_of(glm::min(light, white));
    least = glm::min(least, light);
  }
  Rgb most(std::numeric_limits<float>::max());
  for (int band = 0; band < 3; ++band) {
    if (least[band] >= white[band]) most[band] = white[band];
  }

  Share share;
  const std::uint32_t first = samples.first_of_element[e], last = samples.first_of_element[e + 1];
  const double count = last - first;
  for (std::uint32_t s = first; s < last; ++s) {
    const double truth = double{luminance_of(glm::min(shown.under(e, samples.irradiance[s]), most))};
    const double residual = double{glm::dot(samples.weights[s], at_corners)} - truth;
    share.squared += residual * residual / count;
    share.value += truth / count;
  }
  return share;
}

/// Samples at equal steps of area over the whole surface.
std::vector<std::uint32_t> spread_by_area(const RefinedMesh& mesh, const Samples& samples, std::size_t count) {
  double total = 0.0;
  for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) {
    if (has_samples(samples, e)) total += double{element_area(mesh, e)};
  }
  std::vector<std::uint32_t> chosen;
  double due = 0.5;
  for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) {
    const std::uint32_t first = samples.first_of_element[e], last = samples.first_of_element[e + 1];
    for (std::uint32_t s = first; s < last; ++s) {
      due += static_cast<double>(count) * double{element_area(mesh, e)} / (total * (last - first));
      for (; due >= 1.0; due -= 1.0) chosen.push_back(s);
    }
  }
  return chosen;
}

}  // namespace

Misfit measure_misfit(const Scene& scene, const RefinedMesh& mesh, const Samples& samples,
                      std::span<const Rgb> irradiance, const MisfitOptions& options) {
  // Each element by itself.
  const ShownLight shown = shown_light(scene, mesh);
  const std::vector<double> unknowns = unknowns_per_element(mesh, samples);
  const Rgb white(1.0F / (options.exposure > 0.0F ? options.exposure : exposure_of(mesh, samples, shown)));
  std::vector<Share> share(mesh.elements.size());
  parallel_in_chunks(share.size(), share.size(), {}, "", [&](std::size_t element) {
    const auto e = static_cast<std::uint32_t>(element);
    if (!has_samples(samples, e)) return;
    share[e] = share_of(e, mesh, samples, irradiance, shown, white);
    const double count = samples.first_of_element[e + 1] - samples.first_of_element[e];
    const double unfitted = 1.0 - std::min(kMostLeverage, unknowns[e] / count);
    share[e].squared /= unfitted * unfitted;
  });

  // The whole. What the samples' noise leaves in the fit is the least that is wrong.
  double squared = 0.0, value = 0.0, total = 0.0, unknown_count = 0.0;
  for (std::uint32_t e = 0; e < share.size(); ++e) {
    const double area = has_samples(samples, e) ? double{element_area(mesh, e)} : 0.0;
    squared += area * share[e].squared;
    value += area * share[e].value;
    total += area;
    unknown_count += unknowns[e];
  }
  Misfit misfit{std::vector<double>(share.size(), 0.0), 0.0};
  if (!(value > 0.0)) return misfit;
  const double mean = value / total;
  const double noise = options.variance * unknown_count / static_cast<double>(samples.sample_count());
  misfit.relative_rmse = std::sqrt(std::max(noise, squared / total - options.variance)) / mean;

  for (std::uint32_t e = 0; e < share.size(); ++e) {
    const double weight = options.space == ErrorSpace::kLinear ? 1.0 : 2.0 * mean / (mean + share[e].value);
    misfit.of_element[e] = double{element_area(mesh, e)} * share[e].squared * weight;
  }
  return misfit;
}

double sample_variance(const RefinedMesh& mesh, const Samples& samples, const Gatherer& gatherer, std::size_t count,
                       const Progress& progress) {
  const ShownLight shown = shown_light(gatherer.scene, mesh);
  const std::vector<std::uint32_t> chosen = spread_by_area(mesh, samples, count);
  std::vector<double> squared(chosen.size());
  parallel_in_chunks(chosen.size(), 256, progress, "gather", [&](std::size_t k) {
    const std::uint32_t s = chosen[k];
    const auto after = std::upper_bound(samples.first_of_element.begin(), samples.first_of_element.end(), s);
    const auto e = static_cast<std::uint32_t>(after - samples.first_of_element.begin() - 1);
    const auto number = samples.taken + static_cast<std::uint32_t>(k);
    const Gathered again = gather_sample(mesh, gatherer, e, number, samples.weights[s]);
    const double difference = double{luminance_of(shown.under(e, again.irradiance))} -
                              double{luminance_of(shown.under(e, samples.irradiance[s]))};
    squared[k] = 0.5 * difference * difference;
  });
  double sum = 0.0;
  for (const double one : squared) sum += one;
  return squared.empty() ? 0.0 : sum / static_cast<double>(squared.size());
}

std::vector<std::uint32_t> worst_elements(const Misfit& misfit, std::span<const std::uint8_t> may_be_cut) {
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
  for (; taken < most && (left > 0.0 || taken < count / kLeastShare + 1); ++taken) {
    left -= misfit.of_element[elements[taken]];
  }
  elements.resize(taken);
  return elements;
}

}  // namespace radiosity
