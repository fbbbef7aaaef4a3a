#include "core/reconstruct/fit_vertices.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vector_relational.hpp>

#include "core/photometry.h"
#include "core/reconstruct/smooth_groups.h"

namespace radiosity {
namespace {

/// One element's share of the normal equations: a symmetric 3 x 3 matrix over the groups of its corners.
struct ElementMatrix {
  std::array<std::uint32_t, 3> group{};
  double xx = 0.0, yy = 0.0, zz = 0.0, xy = 0.0, xz = 0.0, yz = 0.0;
};

/// With more samples in an element than this, smoothness may fade.
constexpr double kOrdinaryCount = 3.0;

/// The normal equations A x = b of all groups, three bands at once.
struct System {
  std::vector<ElementMatrix> elements;
  std::vector<double> diagonal;         // [group_count]
  std::vector<glm::dvec3> right;        // b, [group_count]
  std::vector<std::uint8_t> held_dark;  // [group_count]: 1 where x stays 0
};

void add_samples(const Samples& samples, std::size_t e, double weight, ElementMatrix& m, System& system) {
  for (std::uint32_t s = samples.first_of_element[e]; s < samples.first_of_element[e + 1]; ++s) {
    const glm::dvec3 w(samples.weights[s]);
    m.xx += weight * w.x * w.x;
    m.yy += weight * w.y * w.y;
    m.zz += weight * w.z * w.z;
    m.xy += weight * w.x * w.y;
    m.xz += weight * w.x * w.z;
    m.yz += weight * w.y * w.z;
    for (std::size_t k = 0; k < 3; ++k) {
      system.right[m.group[k]] += weight * w[static_cast<int>(k)] * glm::dvec3(samples.irradiance[s]);
    }
  }
}

/// Differences along the three edges, squared.
void add_smoothness(double weight, ElementMatrix& m) {
  m.xx += 2.0 * weight;
  m.yy += 2.0 * weight;
  m.zz += 2.0 * weight;
  m.xy -= weight;
  m.xz -= weight;
  m.yz -= weight;
}

System make_system(const RefinedMesh& mesh, const Samples& samples, const SmoothGroups& groups,
                   const FitOptions& options) {
  System system{{},
                std::vector<double>(groups.group_count, 0.0),
                std::vector<glm::dvec3>(groups.group_count, glm::dvec3(0.0)),
                std::vector<std::uint8_t>(groups.group_count, 0)};
  for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) {
    const double area = double{element_area(mesh, e)};
    if (!(area > 0.0)) continue;
    ElementMatrix m;
    for (std::size_t k = 0; k < 3; ++k) m.group[k] = groups.group_of_vertex[mesh.elements[e][static_cast<int>(k)]];
    const std::uint32_t count = samples.first_of_element[e + 1] - samples.first_of_element[e];
    if (count > 0) add_samples(samples, e, area / count, m, system);
    const double scarcity = options.fades ? std::min(1.0, kOrdinaryCount / count) : 1.0;
    add_smoothness(options.damping * scarcity * scarcity * area, m);
    system.diagonal[m.group[0]] += m.xx;
    system.diagonal[m.group[1]] += m.yy;
    system.diagonal[m.group[2]] += m.zz;
    system.elements.push_back(m);
  }
  return system;
}

/// A x, with rows and columns of groups that are held dark left out.
void multiply(const System& system, const std::vector<glm::dvec3>& x, std::vector<glm::dvec3>& product) {
  std::fill(product.begin(), product.end(), glm::dvec3(0.0));
  for (const ElementMatrix& m : system.elements) {
    const auto [a, b, c] = m.group;
    product[a] += m.xx * x[a] + m.xy * x[b] + m.xz * x[c];
    product[b] += m.xy * x[a] + m.yy * x[b] + m.yz * x[c];
    product[c] += m.xz * x[a] + m.yz * x[b] + m.zz * x[c];
  }
  for (std::size_t g = 0; g < product.size(); ++g) {
    if (system.held_dark[g] != 0) product[g] = glm::dvec3(0.0);
  }
}

glm::dvec3 dot(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b) {
  glm::dvec3 sum(0.0);
  for (std::size_t g = 0; g < a.size(); ++g) sum += a[g] * b[g];
  return sum;
}

glm::dvec3 ratio(const glm::dvec3& a, const glm::dvec3& b) {
  return {b.x > 0.0 ? a.x / b.x : 0.0, b.y > 0.0 ? a.y / b.y : 0.0, b.z > 0.0 ? a.z / b.z : 0.0};
}

/// The squared residual of nothing at all.
glm::dvec3 size_of_right(const System& system) {
  glm::dvec3 sum(0.0);
  for (std::size_t g = 0; g < system.right.size(); ++g) {
    if (system.diagonal[g] > 0.0) sum += system.right[g] * system.right[g] / system.diagonal[g];
  }
  return sum;
}

/// Conjugate gradients, preconditioned by the diagonal, each band for itself. Hestenes and Stiefel 1952.
void solve(const System& system, int max_iterations, std::vector<glm::dvec3>& x) {
  const std::size_t count = x.size();
  constexpr double kEnough = 1e-12;  // of the squared right side
  std::vector<glm::dvec3> residual(count), direction(count), scaled(count), product(count);
  multiply(system, x, product);
  for (std::size_t g = 0; g < count; ++g) {
    residual[g] = system.held_dark[g] != 0 ? glm::dvec3(0.0) : system.right[g] - product[g];
    scaled[g] = system.diagonal[g] > 0.0 ? residual[g] / system.diagonal[g] : glm::dvec3(0.0);
  }
  direction = scaled;
  glm::dvec3 progress = dot(residual, scaled);
  const glm::dvec3 enough = kEnough * size_of_right(system);
  assert(!glm::any(glm::isnan(progress)));
  for (int k = 0; k < max_iterations && glm::any(glm::greaterThan(progress, enough)); ++k) {
    multiply(system, direction, product);
    const glm::dvec3 step = ratio(progress, dot(direction, product));
    for (std::size_t g = 0; g < count; ++g) {
      x[g] += step * direction[g];
      residual[g] -= step * product[g];
      if (system.diagonal[g] > 0.0) scaled[g] = residual[g] / system.diagonal[g];
    }
    const glm::dvec3 next = dot(residual, scaled);
    const glm::dvec3 turn = ratio(next, progress);
    for (std::size_t g = 0; g < count; ++g) direction[g] = scaled[g] + turn * direction[g];
    progress = next;
  }
}

/// A first guess: the mean of the samples around, spread to where there are none.
std::vector<glm::dvec3> first_guess(const RefinedMesh& mesh, const Samples& samples, const SmoothGroups& groups) {
  std::vector<glm::dvec3> sum(groups.group_count, glm::dvec3(0.0));
  std::vector<double> weight(groups.group_count, 0.0);
  const ElementLight light = mean_of_samples(samples);
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

/// Groups whose light came out negative in any band are held at none; returns how many are new.
std::size_t hold_dark(const std::vector<glm::dvec3>& x, System& system) {
  std::size_t held = 0;
  for (std::size_t g = 0; g < x.size(); ++g) {
    if (system.held_dark[g] != 0 || luminance_of(Rgb(x[g])) >= 0.0F) continue;
    system.held_dark[g] = 1;
    ++held;
  }
  return held;
}

}  // namespace

std::vector<Rgb> fit_vertices(const RefinedMesh& mesh, const Samples& samples, const FitOptions& options,
                              std::span<const Rgb> guess) {
  const SmoothGroups groups = find_smooth_groups(mesh);
  System system = make_system(mesh, samples, groups, options);
  std::vector<glm::dvec3> value = guess.empty() ? first_guess(mesh, samples, groups) : by_group(groups, guess);
  solve(system, options.max_iterations, value);

  // Where the fit undershoots below zero it is held at zero, and the rest fits itself to that.
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds && hold_dark(value, system) > 0; ++round) {
    for (std::size_t g = 0; g < value.size(); ++g) {
      if (system.held_dark[g] != 0) value[g] = glm::dvec3(0.0);
    }
    solve(system, options.max_iterations, value);
  }

  std::vector<Rgb> irradiance(mesh.positions.size());
  for (std::size_t v = 0; v < irradiance.size(); ++v) {
    irradiance[v] = glm::max(Rgb(value[groups.group_of_vertex[v]]), Rgb(0.0F));
  }
  return irradiance;
}

}  // namespace radiosity
