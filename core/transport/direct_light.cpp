#include "core/transport/direct_light.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "core/parallel.h"
#include "core/photometry.h"

namespace radiosity {
namespace {

/// Beyond this many edge lengths a lamp counts as a point: 1/2 per cent wrong at most.
constexpr float kPointLike = 6.0F;

/// A polygon cut off at a horizon: a triangle keeps at most four corners.
struct Polygon {
  glm::vec3 corner[4];
  int count = 0;
};

/// The part of a triangle above the plane through the origin. Sutherland and Hodgman, Reentrant Polygon Clipping, 1974.
Polygon above_horizon(const glm::vec3 corner[3], const SurfacePoint& at) {
  glm::vec3 relative[3];
  float height[3];
  for (int k = 0; k < 3; ++k) {
    relative[k] = corner[k] - at.position;
    height[k] = glm::dot(relative[k], at.normal);
  }
  Polygon polygon;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    if (height[k] > 0.0F) polygon.corner[polygon.count++] = relative[k];
    if ((height[k] > 0.0F) != (height[next] > 0.0F)) {
      const float t = height[k] / (height[k] - height[next]);
      polygon.corner[polygon.count++] = glm::mix(relative[k], relative[next], t);
    }
  }
  return polygon;
}

/// Irradiance at unit luminance from a lamp so far off that it counts as a point.
float point_like_irradiance(const EmissiveTile& lamp, const glm::vec3& middle, const SurfacePoint& at) {
  const glm::vec3 scaled_normal = 0.5F * glm::cross(lamp.corner[1] - lamp.corner[0], lamp.corner[2] - lamp.corner[0]);
  const glm::vec3 to_lamp = middle - at.position;
  const float d2 = glm::dot(to_lamp, to_lamp);
  const float at_lamp = -glm::dot(scaled_normal, to_lamp), here = glm::dot(at.normal, to_lamp);
  return here <= 0.0F ? 0.0F : at_lamp * here / (d2 * d2);
}

glm::vec3 middle_of(const EmissiveTile& lamp) { return (lamp.corner[0] + lamp.corner[1] + lamp.corner[2]) / 3.0F; }

/// A hash of an index, [0,1): shifts a sequence by a different amount at each point.
float shift(std::uint32_t index, std::uint32_t salt) {
  std::uint32_t h = index * 0x9E3779B9U + salt * 0x85EBCA6BU;
  h = (h ^ (h >> 16U)) * 0x7FEB352DU;
  h = (h ^ (h >> 15U)) * 0x846CA68BU;
  h ^= h >> 16U;
  return static_cast<float>(h >> 8U) * 0x1p-24F;
}

float wrap(float x) { return x - std::floor(x); }

/// How much of a light's intensity remains at a distance, as KHR_lights_punctual defines it (1/m2).
float attenuation(const Light& light, float distance) {
  float share = 1.0F;
  if (light.range > 0.0F) share = std::clamp(1.0F - std::pow(distance / light.range, 4.0F), 0.0F, 1.0F);
  return share / std::max(distance * distance, 1e-8F);
}

/// A spot's falloff between its cones, likewise.
float spot_falloff(const Light& light, const glm::vec3& to_light) {
  const float scale = 1.0F / std::max(0.001F, light.inner_cone_cos - light.outer_cone_cos);
  const float share = std::clamp((glm::dot(light.direction, -to_light) - light.outer_cone_cos) * scale, 0.0F, 1.0F);
  return share * share;
}

/// Working memory of one thread, reused from point to point.
struct Scratch {
  std::vector<float> irradiance;  // per lamp, at its own luminance's eye-weighted sum
  std::vector<double> cumulative;
  std::vector<ShadowRay> rays;
  std::vector<std::uint32_t> lamp_of_ray;
  std::vector<std::uint8_t> blocked;
};

}  // namespace

float triangle_irradiance(const glm::vec3 corner[3], const SurfacePoint& at) {
  const Polygon polygon = above_horizon(corner, at);
  if (polygon.count < 3) return 0.0F;

  // Lambert: half the sum, over the edges, of the angle each spans times the cosine to its plane's normal.
  double sum = 0.0;
  for (int k = 0; k < polygon.count; ++k) {
    const glm::dvec3 a = polygon.corner[k], b = polygon.corner[(k + 1) % polygon.count];
    const glm::dvec3 normal = glm::cross(a, b);
    const double sine = glm::length(normal);
    if (sine > 0.0) sum += std::atan2(sine, glm::dot(a, b)) / sine * glm::dot(normal, glm::dvec3(at.normal));
  }
  return static_cast<float>(-0.5 * sum);
}

DirectLight::DirectLight(const RayScene& rays, const Patches& patches, const DirectLightOptions& options)
    : rays_(rays), patches_(patches), options_(options), offset_(surface_offset(rays.scene())) {
  reach2_.reserve(patches.lamps.size());
  for (const EmissiveTile& lamp : patches.lamps) {
    float longest = 0.0F;
    for (int k = 0; k < 3; ++k) longest = std::max(longest, glm::distance(lamp.corner[k], lamp.corner[(k + 1) % 3]));
    reach2_.push_back(kPointLike * kPointLike * longest * longest);
  }
}

Rgb DirectLight::at(const SurfacePoint& point, std::uint32_t index) const {
  return from_lamps(point, index) + from_lights(point, index);
}

Rgb DirectLight::from_lamps(const SurfacePoint& point, std::uint32_t index) const {
  if (patches_.lamps.empty()) return Rgb(0.0F);
  thread_local Scratch scratch;

  // What each lamp would bring if nothing were in between.
  const std::size_t lamp_count = patches_.lamps.size();
  scratch.irradiance.resize(lamp_count);
  scratch.cumulative.resize(lamp_count);
  double total = 0.0;
  for (std::size_t k = 0; k < lamp_count; ++k) {
    const EmissiveTile& lamp = patches_.lamps[k];
    const glm::vec3 middle = middle_of(lamp);
    const glm::vec3 apart = middle - point.position;
    float unit = glm::dot(apart, apart) > reach2_[k] ? point_like_irradiance(lamp, middle, point)
                                                     : triangle_irradiance(lamp.corner, point);
    unit = lamp.two_sided ? std::abs(unit) : std::max(unit, 0.0F);
    scratch.irradiance[k] = unit;
    total += double{unit} * double{luminance_of(lamp.luminance)};
    scratch.cumulative[k] = total;
  }
  if (!(total > 0.0)) return Rgb(0.0F);

  // One ray to each of evenly spaced places along the cumulative contribution; `stride` apart in the first pass.
  const glm::vec3 from = point.position + offset_ * point.normal;
  const int ray_count = options_.lamp_rays, stride = std::max(1, ray_count / options_.probe_rays);
  const float offset_along = shift(index, 1), offset_x = shift(index, 2), offset_y = shift(index, 3);
  const auto add_ray = [&](int r) {
    const double along = (r + double{offset_along}) / ray_count * total;
    const auto found = std::lower_bound(scratch.cumulative.begin(), scratch.cumulative.end(), along);
    const auto k = std::min(static_cast<std::size_t>(found - scratch.cumulative.begin()), lamp_count - 1);
    const EmissiveTile& lamp = patches_.lamps[k];
    glm::vec2 at(wrap(offset_x + static_cast<float>(r) * 0.75487767F),
                 wrap(offset_y + static_cast<float>(r) * 0.56984029F));
    if (at.x + at.y > 1.0F) at = 1.0F - at;
    const glm::vec3 target =
        lamp.corner[0] + at.x * (lamp.corner[1] - lamp.corner[0]) + at.y * (lamp.corner[2] - lamp.corner[0]);
    const float distance = std::max(glm::distance(target, from), 1e-20F);
    scratch.rays.push_back({from, (target - from) / distance,
                            std::max(0.0F, distance * (1.0F - 1e-4F) - 2.0F * offset_),
                            wrap(offset_along + static_cast<float>(r) * 0.61803399F)});
    scratch.lamp_of_ray.push_back(static_cast<std::uint32_t>(k));
  };
  scratch.rays.clear();
  scratch.lamp_of_ray.clear();
  const auto trace_from = [&](std::size_t first) {
    scratch.blocked.resize(scratch.rays.size());
    trace_shadow_rays(rays_, std::span(scratch.rays).subspan(first), std::span(scratch.blocked).subspan(first));
  };
  for (int r = 0; r < ray_count; r += stride) add_ray(r);
  trace_from(0);

  // Where the probes disagree lies a penumbra: send the rest.
  const auto blocked_count = std::count(scratch.blocked.begin(), scratch.blocked.end(), std::uint8_t{1});
  if (blocked_count != 0 && blocked_count != std::ssize(scratch.blocked)) {
    const std::size_t first = scratch.rays.size();
    for (int r = 0; r < ray_count; ++r) {
      if (r % stride != 0) add_ray(r);
    }
    trace_from(first);
  }

  // A ray stands for an equal share of the total, in the colour of its lamp.
  glm::dvec3 sum(0.0);
  for (std::size_t r = 0; r < scratch.rays.size(); ++r) {
    if (scratch.blocked[r] != 0) continue;
    const Rgb& luminance = patches_.lamps[scratch.lamp_of_ray[r]].luminance;
    sum += glm::dvec3(luminance) / double{luminance_of(luminance)};
  }
  return Rgb(sum * (total / static_cast<double>(scratch.rays.size())));
}

Rgb DirectLight::from_lights(const SurfacePoint& point, std::uint32_t index) const {
  const std::vector<Light>& lights = rays_.scene().lights;
  if (lights.empty()) return Rgb(0.0F);
  thread_local Scratch scratch;
  thread_local std::vector<Rgb> unoccluded;
  scratch.rays.clear();
  unoccluded.clear();

  // What each light would bring, and the ray that asks whether it does.
  const glm::vec3 from = point.position + offset_ * point.normal;
  for (const Light& light : lights) {
    ShadowRay ray{from, -light.direction, std::numeric_limits<float>::infinity(), shift(index, 4)};
    Rgb irradiance = light.intensity;
    if (light.kind != Light::Kind::kDirectional) {
      ray.distance = std::max(glm::distance(light.position, from), 1e-20F);
      ray.to_target = (light.position - from) / ray.distance;
      irradiance *= attenuation(light, ray.distance);
      ray.distance *= 1.0F - 1e-4F;
    }
    if (light.kind == Light::Kind::kSpot) irradiance *= spot_falloff(light, ray.to_target);
    irradiance *= std::max(0.0F, glm::dot(point.normal, ray.to_target));
    if (luminance_of(irradiance) <= 0.0F) continue;
    scratch.rays.push_back(ray);
    unoccluded.push_back(irradiance);
  }

  scratch.blocked.resize(scratch.rays.size());
  trace_shadow_rays(rays_, scratch.rays, scratch.blocked);
  Rgb sum(0.0F);
  for (std::size_t k = 0; k < unoccluded.size(); ++k) {
    if (scratch.blocked[k] == 0) sum += unoccluded[k];
  }
  return sum;
}

std::vector<Rgb> direct_on_patches(const DirectLight& direct, const Patches& patches, const Progress& progress) {
  std::vector<Rgb> irradiance(patches.patch_count());
  parallel_in_chunks(irradiance.size(), 512, progress, "direct", [&](std::size_t i) {
    const std::span<const SurfacePoint> points = patches.points_of(static_cast<std::uint32_t>(i));
    Rgb sum(0.0F);
    for (std::size_t k = 0; k < points.size(); ++k) {
      sum += direct.at(points[k], static_cast<std::uint32_t>(i * points.size() + k));
    }
    irradiance[i] = sum / static_cast<float>(points.size());
  });
  return irradiance;
}

}  // namespace radiosity
