#include "core/reconstruct/interpolate_vertices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "core/mesh/weld.h"

namespace radiosity {
namespace {

constexpr float kSmoothCos = 0.9659258F;  // 15 degrees

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

std::vector<glm::vec3> vertex_normals(const RefinedMesh& mesh) {
  std::vector<glm::vec3> normals = mesh.normals;
  std::vector<glm::vec3> mean(normals.size(), glm::vec3(0.0F));
  for (const glm::uvec3& e : mesh.elements) {
    const glm::vec3 scaled =
        glm::cross(mesh.positions[e.y] - mesh.positions[e.x], mesh.positions[e.z] - mesh.positions[e.x]);
    for (int k = 0; k < 3; ++k) mean[e[k]] += scaled;
  }
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const float length = glm::length(mean[v]);
    if (glm::dot(normals[v], normals[v]) < 0.25F && length > 0.0F) normals[v] = mean[v] / length;
  }
  return normals;
}

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
    if (light.buried[e] != 0) continue;
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

/// Lets light spread along elements to groups that have none, a ring at a time.
void spread_to_unknown(const RefinedMesh& mesh, const SmoothGroups& groups, std::vector<std::uint8_t>& known,
                       std::vector<Rgb>& value) {
  std::vector<glm::vec4> sum(known.size());
  for (bool changed = true; changed;) {
    std::fill(sum.begin(), sum.end(), glm::vec4(0.0F));
    for (const glm::uvec3& element : mesh.elements) {
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t to = groups.group_of_vertex[element[k]],
                            from = groups.group_of_vertex[element[(k + 1) % 3]];
        if (known[to] == 0 && known[from] != 0) sum[to] += glm::vec4(value[from], 1.0F);
        if (known[from] == 0 && known[to] != 0) sum[from] += glm::vec4(value[to], 1.0F);
      }
    }
    changed = false;
    for (std::size_t g = 0; g < known.size(); ++g) {
      if (sum[g].w <= 0.0F) continue;
      value[g] = Rgb(sum[g]) / sum[g].w;
      known[g] = 1;
      changed = true;
    }
  }
}

}  // namespace

SmoothGroups find_smooth_groups(const RefinedMesh& mesh) {
  const Weld welded = weld(mesh.positions);
  const std::vector<glm::vec3> normals = vertex_normals(mesh);

  // Within a weld class a vertex joins the first group whose founder's normal agrees; groups of a class form a chain.
  SmoothGroups groups;
  groups.group_of_vertex.resize(mesh.positions.size());
  std::vector<std::uint32_t> first_of_class(welded.class_count, kNothing), next_of_group, founder;
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    std::uint32_t* link = &first_of_class[welded.class_of_vertex[v]];
    while (*link != kNothing && glm::dot(normals[founder[*link]], normals[v]) < kSmoothCos)
      link = &next_of_group[*link];
    if (*link == kNothing) {
      *link = groups.group_count;
      groups.group_of_vertex[v] = groups.group_count++;
      founder.push_back(v);
      next_of_group.push_back(kNothing);  // `link` may dangle from here on
    } else {
      groups.group_of_vertex[v] = *link;
    }
  }
  return groups;
}

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
