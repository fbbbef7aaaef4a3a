#include "core/mesh/removed_places.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace radiosity {
namespace {

double least(const glm::dvec3& weights) { return std::min({weights.x, weights.y, weights.z}); }

/// Beside an element its rim stands for it.
glm::vec3 clamped(const glm::dvec3& weights) {
  const glm::dvec3 inside = glm::max(weights, glm::dvec3(0.0));
  return glm::vec3(inside / (inside.x + inside.y + inside.z));
}

}  // namespace

Stand::Stand(const RefinedMesh& mesh, const glm::uvec3& corners)
    : corners_(corners),
      origin_(mesh.positions[corners.x]),
      u_(glm::dvec3(mesh.positions[corners.y]) - origin_),
      v_(glm::dvec3(mesh.positions[corners.z]) - origin_),
      uu_(glm::dot(u_, u_)),
      uv_(glm::dot(u_, v_)),
      vv_(glm::dot(v_, v_)),
      area_(uu_ * vv_ - uv_ * uv_) {}

glm::dvec3 Stand::weights_at(const glm::dvec3& at) const {
  const glm::dvec3 w = at - origin_;
  const double wu = glm::dot(w, u_), wv = glm::dot(w, v_);
  const double y = (vv_ * wu - uv_ * wv) / area_, z = (uu_ * wv - uv_ * wu) / area_;
  return {1.0 - y - z, y, z};
}

Deviation::Found Deviation::find(const Place& place, std::span<const Stand> stands) const {
  const glm::dvec3 at = 0.5 * (glm::dvec3(mesh_.positions[place.x]) + glm::dvec3(mesh_.positions[place.y]));
  Found found;
  glm::dvec3 best(0.0);
  double depth = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < stands.size(); ++k) {
    const glm::dvec3 weights = stands[k].weights_at(at);
    if (least(weights) > depth) {
      depth = least(weights);
      best = weights;
      found.stand = k;
    }
  }
  found.weights = clamped(best);
  return found;
}

float Deviation::of(const Place& place, const glm::uvec3& corners, const glm::vec3& weights, float limit) const {
  const auto [a, b] = std::pair(place.x, place.y);

  // The surface. Differences from one corner, which are exact where numbers are large.
  const glm::vec3& origin = mesh_.positions[corners.x];
  const glm::vec3 shown =
      weights.y * (mesh_.positions[corners.y] - origin) + weights.z * (mesh_.positions[corners.z] - origin);
  const glm::vec3 was = 0.5F * ((mesh_.positions[a] - origin) + (mesh_.positions[b] - origin));
  float most = glm::length(shown - was) / carried_.shape_tolerance[a];
  if (!(most <= limit)) return std::numeric_limits<float>::infinity();

  // The light.
  const Rgb signed_change = light_change(place, corners, weights), change = glm::abs(signed_change);
  const float luminance = std::abs(luminance_of(signed_change));
  most = std::max(
      most, std::max({luminance, 0.5F * change.x, 0.5F * change.y, 0.5F * change.z}) / carried_.light_tolerance[a]);
  if (!(most <= limit)) return std::numeric_limits<float>::infinity();

  // Everything else.
  const float* at_a = carried_.values.data() + carried_.first_value[a];
  const float* at_b = carried_.values.data() + carried_.first_value[b];
  const float* at_x = carried_.values.data() + carried_.first_value[corners.x];
  const float* at_y = carried_.values.data() + carried_.first_value[corners.y];
  const float* at_z = carried_.values.data() + carried_.first_value[corners.z];
  const std::size_t count = carried_.values_of(a).size();
  for (std::size_t i = 0; i < count; ++i) {
    const float difference =
        weights.x * at_x[i] + weights.y * at_y[i] + weights.z * at_z[i] - 0.5F * (at_a[i] + at_b[i]);
    if (!(std::abs(difference) <= limit)) return std::numeric_limits<float>::infinity();
    most = std::max(most, std::abs(difference));
  }
  return most;
}

double Deviation::of_luminance(const Place& place, const glm::uvec3& corners, const glm::vec3& weights) const {
  return double{luminance_of(light_change(place, corners, weights))};
}

Rgb Deviation::light_change(const Place& place, const glm::uvec3& corners, const glm::vec3& weights) const {
  const std::vector<Rgb>& light = carried_.light;
  return weights.x * light[corners.x] + weights.y * light[corners.y] + weights.z * light[corners.z] -
         0.5F * (light[place.x] + light[place.y]);
}

}  // namespace radiosity
