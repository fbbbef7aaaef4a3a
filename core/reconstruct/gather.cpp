#include "core/reconstruct/gather.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>

#include "core/parallel.h"
#include "core/photometry.h"
#include "core/transport/sky_light.h"

namespace radiosity {
namespace {

constexpr int kMaxSamplesPerElement = 16;

/// A place inside an element by the weights of its corners.
glm::vec3 corner_weights(int sample, int sample_count) {
  if (sample_count == 1) return glm::vec3(1.0F / 3.0F);
  glm::vec2 at = glm::fract(glm::vec2(0.5F) + static_cast<float>(sample) * glm::vec2(0.75487767F, 0.56984029F));
  if (at.x + at.y > 1.0F) at = 1.0F - at;
  // Kept a little away from the edges, where walls meet.
  at = glm::mix(glm::vec2(1.0F / 3.0F), at, 0.94F);
  return {1.0F - at.x - at.y, at.x, at.y};
}

/// The shading normal at a place of an element. Corners without a normal, or whose normal points to the other side,
/// count as flat.
glm::vec3 shading_normal(const RefinedMesh& mesh, const glm::uvec3& element, const glm::vec3& weights,
                         const glm::vec3& flat) {
  glm::vec3 sum(0.0F);
  for (int k = 0; k < 3; ++k) {
    const glm::vec3& normal = mesh.normals[element[k]];
    sum += weights[k] * (glm::dot(normal, flat) > 0.0F ? normal : flat);
  }
  return glm::normalize(sum);
}

/// Light of one element, or nothing if no sample sees any.
std::optional<Rgb> gather_element(const RefinedMesh& mesh, const Gatherer& gatherer, std::uint32_t e) {
  const glm::uvec3& element = mesh.elements[e];
  const glm::vec3 a = mesh.positions[element.x], b = mesh.positions[element.y], c = mesh.positions[element.z];
  const glm::vec3 scaled = glm::cross(b - a, c - a);
  const float double_area = glm::length(scaled);
  if (!(double_area > 0.0F)) return std::nullopt;
  const glm::vec3 flat = scaled / double_area;

  const std::uint32_t surface = gatherer.scene.surface_of_triangle[mesh.triangle_of_element[e]];
  const bool two_sided = gatherer.scene.surfaces[surface].two_sided;
  const float patch_area = 0.5F * gatherer.patches.size * gatherer.patches.size;
  const int sample_count =
      static_cast<int>(std::clamp(std::ceil(0.5F * double_area / patch_area), 1.0F, float{kMaxSamplesPerElement}));

  Rgb sum(0.0F);
  int valid = 0;
  for (int s = 0; s < sample_count; ++s) {
    const glm::vec3 weights = corner_weights(s, sample_count);
    SurfacePoint point{weights.x * a + weights.y * b + weights.z * c, shading_normal(mesh, element, weights, flat)};
    const std::uint32_t index = e * 7U + static_cast<std::uint32_t>(s);
    Gathered gathered = gatherer.at(point, index);
    if (gathered.back_share > kBuriedShare && two_sided) {
      point.normal = -point.normal;
      gathered = gatherer.at(point, index);
    }
    if (gathered.back_share > kBuriedShare) continue;
    sum += gathered.irradiance;
    ++valid;
  }
  if (valid == 0) return std::nullopt;
  return sum / static_cast<float>(valid);
}

}  // namespace

Gathered Gatherer::at(const SurfacePoint& point, std::uint32_t index) const {
  thread_local ItemBuffer buffer;
  const Viewpoint viewpoint{point.position + offset * point.normal, point.normal, low_discrepancy_twist(index)};
  items.fill(hemicube, viewpoint, buffer);

  // What each cell sees, by how much it counts.
  Gathered gathered;
  Rgb luminance(0.0F);
  const std::span<const float> delta = hemicube.delta_form_factors();
  for (std::size_t c = 0; c < delta.size(); ++c) {
    const std::uint32_t triangle = buffer.triangle[c];
    if (triangle == kNothing) {
      if (sky.is_constant()) luminance += delta[c] * sky.constant();
      continue;
    }
    const std::uint32_t patch = patches.patch_at(triangle, buffer.barycentrics[c], buffer.back[c] != 0);
    if (patch == kNothing) {
      gathered.back_share += delta[c];
    } else {
      luminance += delta[c] * luminance_of_radiosity(radiosity[patch]);
    }
  }
  if (gathered.back_share > kBuriedShare) return gathered;
  if (!sky.is_constant()) luminance += luminance_of_sky(sky, hemicube, viewpoint, buffer);
  gathered.irradiance = irradiance_of_luminance(luminance, 1.0F) + direct.at(point, index);
  return gathered;
}

ElementLight gather_elements(const RefinedMesh& mesh, const Gatherer& gatherer, const Progress& progress) {
  const std::size_t count = mesh.elements.size();
  ElementLight light{std::vector<Rgb>(count, Rgb(0.0F)), std::vector<std::uint8_t>(count, 0)};
  parallel_in_chunks(count, 2048, progress, "gather", [&](std::size_t e) {
    const std::optional<Rgb> gathered = gather_element(mesh, gatherer, static_cast<std::uint32_t>(e));
    light.irradiance[e] = gathered.value_or(Rgb(0.0F));
    light.buried[e] = gathered ? 0 : 1;
  });
  return light;
}

}  // namespace radiosity
