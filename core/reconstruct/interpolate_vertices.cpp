#include "core/reconstruct/interpolate_vertices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace radiosity {
namespace {

/// How strongly slopes are held back, as a share of the elements' own spread.
constexpr double kSlopeDamping = 0.05;

/// Moments of the light of the elements around a vertex, relative to it.
struct Moments {
  double weight = 0.0;
  glm::dvec3 place{0.0};        // sum of w d
  glm::dmat3 spread{0.0};       // sum of w d d^T
  glm::dvec3 light{0.0};        // sum of w H
  glm::dmat3 light_place{0.0};  // column b: sum of w H_b d
  Rgb lowest{std::numeric_limits<float>::max()}, highest{0.0F};
};

/// Value at the vertex of the plane that fits the elements around it. With few elements, or all on one line, the
/// damping turns the plane into their mean.
Rgb value_at_vertex(const Moments& m) {
  const glm::dvec3 mean_place = m.place / m.weight;
  const glm::dvec3 mean_light = m.light / m.weight;
  glm::dmat3 covariance = m.spread / m.weight - glm::outerProduct(mean_place, mean_place);
  const double size = (m.spread[0][0] + m.spread[1][1] + m.spread[2][2]) / m.weight;
  if (!(size > 0.0)) return Rgb(mean_light);
  for (int k = 0; k < 3; ++k) covariance[k][k] += kSlopeDamping * size;
  const glm::dvec3 towards_vertex = glm::inverse(covariance) * -mean_place;

  Rgb value;
  for (int band = 0; band < 3; ++band) {
    const glm::dvec3 together = m.light_place[band] / m.weight - mean_light[band] * mean_place;
    value[band] = static_cast<float>(mean_light[band] + glm::dot(together, towards_vertex));
  }
  // Extrapolation beyond what the elements hold by at most half their range.
  const Rgb slack = 0.5F * (m.highest - m.lowest);
  return glm::max(glm::clamp(value, m.lowest - slack, m.highest + slack), Rgb(0.0F));
}

std::vector<Moments> sum_moments(const RefinedMesh& mesh, const ElementLight& light, const SmoothGroups& groups) {
  std::vector<Moments> moments(groups.group_count);
  for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) {
    if (light.unknown[e] != 0) continue;
    const glm::uvec3& element = mesh.elements[e];
    const glm::vec3 middle = (mesh.positions[element.x] + mesh.positions[element.y] + mesh.positions[element.z]) / 3.0F;
    const double weight = element_area(mesh, e);
    const Rgb& h = light.irradiance[e];
    for (int k = 0; k < 3; ++k) {
      Moments& m = moments[groups.group_of_vertex[element[k]]];
      const glm::dvec3 d = glm::dvec3(middle) - glm::dvec3(mesh.positions[element[k]]);
      m.weight += weight;
      m.place += weight * d;
      m.spread += weight * glm::outerProduct(d, d);
      m.light += weight * glm::dvec3(h);
      for (int band = 0; band < 3; ++band) m.light_place[band] += weight * double{h[band]} * d;
      m.lowest = glm::min(m.lowest, h);
      m.highest = glm::max(m.highest, h);
    }
  }
  return moments;
}

}  // namespace

std::vector<Rgb> interpolate_vertices(const RefinedMesh& mesh, const ElementLight& light) {
  const SmoothGroups groups = find_smooth_groups(mesh);
  const std::vector<Moments> moments = sum_moments(mesh, light, groups);

  std::vector<Rgb> value(groups.group_count, Rgb(0.0F));
  std::vector<std::uint8_t> known(groups.group_count, 0);
  for (std::uint32_t g = 0; g < groups.group_count; ++g) {
    if (!(moments[g].weight > 0.0)) continue;
    value[g] = value_at_vertex(moments[g]);
    known[g] = 1;
  }
  spread_to_unknown(mesh, groups, known, value);

  std::vector<Rgb> irradiance(mesh.positions.size());
  for (std::size_t v = 0; v < irradiance.size(); ++v) irradiance[v] = value[groups.group_of_vertex[v]];
  return irradiance;
}

}  // namespace radiosity
