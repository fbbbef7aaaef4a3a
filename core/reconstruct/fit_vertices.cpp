#include "core/reconstruct/fit_vertices.h"

#include <algorithm>
#include <glm/common.hpp>

namespace radiosity {
namespace {

/// With more samples in an element than this, smoothness may fade.
constexpr double kOrdinaryCount = 3.0;

void add_samples(const Samples& samples, std::size_t e, double weight, FitElement& m) {
  for (std::uint32_t s = samples.first_of_element[e]; s < samples.first_of_element[e + 1]; ++s) {
    const glm::dvec3 w(samples.weights[s]);
    m.xx += weight * w.x * w.x;
    m.yy += weight * w.y * w.y;
    m.zz += weight * w.z * w.z;
    m.xy += weight * w.x * w.y;
    m.xz += weight * w.x * w.z;
    m.yz += weight * w.y * w.z;
  }
}

/// Differences along the three edges, squared.
void add_smoothness(double weight, FitElement& m) {
  m.xx += 2.0 * weight;
  m.yy += 2.0 * weight;
  m.zz += 2.0 * weight;
  m.xy -= weight;
  m.xz -= weight;
  m.yz -= weight;
}

/// The normal equations' right side.
std::vector<glm::dvec3> right_side(const RefinedMesh& mesh, const Samples& samples, const VertexFit& fit,
                                   std::span<const Rgb> irradiance) {
  std::vector<glm::dvec3> right(fit.groups.group_count, glm::dvec3(0.0));
  for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) {
    const double area = double{element_area(mesh, e)};
    const std::uint32_t first = samples.first_of_element[e], last = samples.first_of_element[e + 1];
    if (!(area > 0.0) || first == last) continue;
    const double weight = area / (last - first);
    for (std::uint32_t s = first; s < last; ++s) {
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t group = fit.groups.group_of_vertex[mesh.elements[e][k]];
        right[group] += weight * double{samples.weights[s][k]} * glm::dvec3(irradiance[s]);
      }
    }
  }
  return right;
}

/// A first guess: the mean of the samples around, spread to where there are none.
std::vector<glm::dvec3> first_guess(const RefinedMesh& mesh, const Samples& samples, const SmoothGroups& groups,
                                    std::span<const Rgb> irradiance) {
  std::vector<glm::dvec3> sum(groups.group_count, glm::dvec3(0.0));
  std::vector<double> weight(groups.group_count, 0.0);
  const ElementLight light = mean_of_samples(samples, irradiance);
  for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) {
    if (light.unknown[e] != 0) continue;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t group = groups.group_of_vertex[mesh.elements[e][k]];
      sum[group] += double{element_area(mesh, e)} * glm::dvec3(light.irradiance[e]);
      weight[group] += double{element_area(mesh, e)};
    }
  }
  std::vector<Rgb> value(groups.group_count, Rgb(0.0F));
  std::vector<std::uint8_t> known(groups.group_count, 0);
  for (std::size_t g = 0; g < value.size(); ++g) {
    if (!(weight[g] > 0.0)) continue;
    value[g] = Rgb(sum[g] / weight[g]);
    known[g] = 1;
  }
  spread_to_unknown(mesh, groups, known, value);
  return {value.begin(), value.end()};
}

std::vector<glm::dvec3> by_group(const SmoothGroups& groups, std::span<const Rgb> of_vertex) {
  std::vector<glm::dvec3> value(groups.group_count);
  for (std::size_t v = 0; v < of_vertex.size(); ++v) value[groups.group_of_vertex[v]] = glm::dvec3(of_vertex[v]);
  return value;
}

}  // namespace

VertexFit make_vertex_fit(const RefinedMesh& mesh, const Samples& samples, const FitOptions& options) {
  VertexFit fit{find_smooth_groups(mesh), {}};
  fit.matrix.diagonal.assign(fit.groups.group_count, 0.0);
  for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) {
    const double area = double{element_area(mesh, e)};
    if (!(area > 0.0)) continue;
    FitElement m;
    for (std::size_t k = 0; k < 3; ++k) m.group[k] = fit.groups.group_of_vertex[mesh.elements[e][static_cast<int>(k)]];
    const std::uint32_t count = samples.first_of_element[e + 1] - samples.first_of_element[e];
    if (count > 0) add_samples(samples, e, area / count, m);
    const double scarcity = options.fades ? std::min(1.0, kOrdinaryCount / count) : 1.0;
    add_smoothness(options.damping * scarcity * scarcity * area, m);
    fit.matrix.add(m);
  }
  return fit;
}

std::vector<glm::dvec3> fit_freely(const RefinedMesh& mesh, const Samples& samples, const VertexFit& fit,
                                   std::span<const Rgb> irradiance) {
  // These are not cut off, so that they add up: they should be exact.
  constexpr int kMaxIterations = 2000;
  std::vector<glm::dvec3> value = first_guess(mesh, samples, fit.groups, irradiance);
  solve(fit.matrix, right_side(mesh, samples, fit, irradiance), {}, kMaxIterations, value);
  return value;
}

std::vector<Rgb> of_vertices(std::span<const std::uint32_t> group_of_vertex, std::span<const glm::dvec3> value) {
  std::vector<Rgb> irradiance(group_of_vertex.size());
  for (std::size_t v = 0; v < irradiance.size(); ++v) {
    irradiance[v] = glm::max(Rgb(value[group_of_vertex[v]]), Rgb(0.0F));
  }
  return irradiance;
}

std::vector<Rgb> fit_vertices(const RefinedMesh& mesh, const Samples& samples, const FitOptions& options,
                              std::span<const Rgb> guess) {
  const VertexFit fit = make_vertex_fit(mesh, samples, options);
  const std::vector<glm::dvec3> right = right_side(mesh, samples, fit, samples.irradiance);
  std::vector<glm::dvec3> value =
      guess.empty() ? first_guess(mesh, samples, fit.groups, samples.irradiance) : by_group(fit.groups, guess);
  solve(fit.matrix, right, {}, options.max_iterations, value);
  hold_dark(fit.matrix, right, options.max_iterations, value);
  return of_vertices(fit.groups.group_of_vertex, value);
}

}  // namespace radiosity
