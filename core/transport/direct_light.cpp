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

/// A hash of an index, [0,1): shifts a sequence by a different amount at each point.
float shift(std::uint32_t index, std::uint32_t salt) {
  std::uint32_t h = index * 0x9E3779B9U + salt * 0x85EBCA6BU;
  h = (h ^ (h >> 16U)) * 0x7FEB352DU;
  h = (h ^ (h >> 15U)) * 0x846CA68BU;
  h ^= h >> 16U;
  return static_cast<float>(h >> 8U) * 0x1p-24F;
}

/// Rays to a light without extent differ only in the opacity that stops them. Where nothing is see-through one will do;
/// else a packet of Embree's, which finds what passes to a sixteenth.
int rays_to_each_light(const Scene& scene) {
  constexpr int kPacket = 16;
  const bool see_through = std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                                       [](const Surface& surface) { return surface.see_through; });
  return see_through ? kPacket : 1;
}

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
  LampWeights weights;
  std::vector<double> sky_weights;
  std::vector<ShadowRay> rays;
  std::vector<Rgb> irradiance;  // what each ray brings if it is free, times the number of rays
  std::vector<std::uint8_t> blocked;

  void clear() {
    rays.clear();
    irradiance.clear();
    blocked.clear();
  }
  /// Traces the rays added since the last call.
  void trace(const RayScene& scene) {
    const std::size_t first = blocked.size();
    blocked.resize(rays.size());
    trace_shadow_rays(scene, std::span(rays).subspan(first), std::span(blocked).subspan(first));
  }
  Rgb sum_of_free() const {
    glm::dvec3 sum(0.0);
    for (std::size_t r = 0; r < rays.size(); ++r) {
      if (blocked[r] == 0) sum += glm::dvec3(irradiance[r]);
    }
    return Rgb(sum);
  }
};

/// Mean over `ray_count` evenly spaced rays of what reaches the point; `add_ray(r)` adds the ray of step r. Probes
/// first, starting at any of the first few steps: always at step 0 they would favour the lamps that come first. Where
/// they disagree lies a penumbra: send the rest.
template <typename AddRay>
Rgb trace_as_needed(const RayScene& scene, const DirectLightOptions& options, float start, Scratch& scratch,
                    const AddRay& add_ray) {
  const int stride = std::max(1, options.lamp_rays / options.probe_rays);
  const int first_probe = static_cast<int>(start * static_cast<float>(stride));
  for (int r = first_probe; r < options.lamp_rays; r += stride) add_ray(r);
  scratch.trace(scene);
  const auto blocked_count = std::count(scratch.blocked.begin(), scratch.blocked.end(), std::uint8_t{1});
  if (blocked_count != 0 && blocked_count != std::ssize(scratch.blocked)) {
    for (int r = 0; r < options.lamp_rays; ++r) {
      if (r % stride != first_probe) add_ray(r);
    }
    scratch.trace(scene);
  }
  return scratch.sum_of_free() / static_cast<float>(scratch.rays.size());
}

}  // namespace

DirectLight::DirectLight(const RayScene& rays, const Patches& patches, const DirectLightOptions& options)
    : rays_(rays),
      lamps_(patches.lamps, surface_offset(rays.scene())),
      bright_sky_(rays.scene().sky),
      options_(options),
      rays_to_each_light_(rays_to_each_light(rays.scene())),
      offset_(surface_offset(rays.scene())) {}

Rgb DirectLight::at(const SurfacePoint& point, std::uint32_t index) const {
  return from_lamps(point, index) + from_lights(point, index) + from_sky(point, index);
}

Rgb DirectLight::from_lamps(const SurfacePoint& point, std::uint32_t index) const {
  if (lamps_.empty()) return Rgb(0.0F);
  thread_local Scratch scratch;
  scratch.clear();
  lamps_.weigh(point, scratch.weights);
  if (!(scratch.weights.total > 0.0)) return Rgb(0.0F);

  // A ray to a place on the lamp that is due at step r of evenly spaced steps.
  const glm::vec3 from = point.position + offset_ * point.normal;
  const glm::vec3 start(shift(index, 1), shift(index, 2), shift(index, 3));
  const auto add_ray = [&](int r) {
    const auto step = static_cast<float>(r);
    const ChosenLamp chosen = lamps_.choose(scratch.weights, (r + double{start.x}) / options_.lamp_rays);
    const auto& corner = lamps_.tile(chosen.lamp).corner;
    glm::vec2 at = glm::fract(glm::vec2(start.y, start.z) + step * glm::vec2(0.75487767F, 0.56984029F));
    if (at.x + at.y > 1.0F) at = 1.0F - at;
    const glm::vec3 target = corner[0] + at.x * (corner[1] - corner[0]) + at.y * (corner[2] - corner[0]);
    const float distance = std::max(glm::distance(target, from), 1e-20F);
    const float free_distance = std::max(0.0F, distance * (1.0F - 1e-4F) - 2.0F * offset_);
    scratch.rays.push_back({from, (target - from) / distance, free_distance, glm::fract(start.x + step * 0.61803399F)});
    scratch.irradiance.push_back(chosen.irradiance);
  };

  return trace_as_needed(rays_, options_, shift(index, 5), scratch, add_ray);
}

Rgb DirectLight::from_sky(const SurfacePoint& point, std::uint32_t index) const {
  if (bright_sky_.empty()) return Rgb(0.0F);
  thread_local Scratch scratch;
  scratch.clear();
  if (!(bright_sky_.weigh(point.normal, scratch.sky_weights) > 0.0)) return Rgb(0.0F);
  const glm::vec3 from = point.position + offset_ * point.normal;
  const glm::vec3 start(shift(index, 6), shift(index, 7), shift(index, 8));
  const auto add_ray = [&](int r) {
    const auto step = static_cast<float>(r);
    const double along = (r + double{start.x}) / options_.lamp_rays;
    const glm::vec2 place = glm::fract(glm::vec2(start.y, start.z) + step * glm::vec2(0.75487767F, 0.56984029F));
    const ChosenDirection chosen = bright_sky_.choose(scratch.sky_weights, along, place);
    scratch.rays.push_back(
        {from, chosen.direction, std::numeric_limits<float>::infinity(), glm::fract(start.x + step * 0.61803399F)});
    scratch.irradiance.push_back(chosen.irradiance);
  };
  return trace_as_needed(rays_, options_, shift(index, 9), scratch, add_ray);
}

Rgb DirectLight::from_lights(const SurfacePoint& point, std::uint32_t index) const {
  const std::vector<Light>& lights = rays_.scene().lights;
  if (lights.empty()) return Rgb(0.0F);
  thread_local Scratch scratch;
  scratch.clear();

  // What each light would bring, and the ray that asks whether it does.
  const glm::vec3 from = point.position + offset_ * point.normal;
  for (const Light& light : lights) {
    ShadowRay ray{from, -light.direction, std::numeric_limits<float>::infinity(), 0.0F};
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
    const auto count = static_cast<float>(rays_to_each_light_);
    for (int r = 0; r < rays_to_each_light_; ++r) {
      ray.threshold = (static_cast<float>(r) + shift(index, 4)) / count;
      scratch.rays.push_back(ray);
      scratch.irradiance.push_back(irradiance / count);
    }
  }
  scratch.trace(rays_);
  return scratch.sum_of_free();
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
