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

}  // namespace

/// Working memory of one thread, reused from point to point.
struct DirectLight::Scratch {
  LampWeights weights;
  std::vector<double> sky_weights;
  std::vector<ShadowRay> rays;
  std::vector<Rgb> irradiance;             // what each ray brings if it is free, times the number of rays
  std::vector<std::uint32_t> light_group;  // that it belongs to
  std::vector<std::uint8_t> blocked;
  float ray_count = 1.0F;  // what the sum is divided by

  void clear() {
    rays.clear();
    irradiance.clear();
    light_group.clear();
    blocked.clear();
    ray_count = 1.0F;
  }
  void add(const ShadowRay& ray, const Rgb& brings, std::uint32_t group) {
    rays.push_back(ray);
    irradiance.push_back(brings);
    light_group.push_back(group);
  }
  /// Traces the rays added since the last call.
  void trace(const RayScene& scene) {
    const std::size_t first = blocked.size();
    blocked.resize(rays.size());
    trace_shadow_rays(scene, std::span(rays).subspan(first), std::span(blocked).subspan(first));
  }

  /// Traces up to `lamp_rays` evenly spaced rays; `add_ray(r)` adds the ray of step r. Probes first, starting at any of
  /// the first few steps: always at step 0 they would favour the lamps that come first. Where they disagree lies a
  /// penumbra: send the rest.
  template <typename AddRay>
  void trace_as_needed(const RayScene& scene, const DirectLightOptions& options, float start, const AddRay& add_ray) {
    const int stride = std::max(1, options.lamp_rays / options.probe_rays);
    const int first_probe = static_cast<int>(start * static_cast<float>(stride));
    for (int r = first_probe; r < options.lamp_rays; r += stride) add_ray(r);
    trace(scene);
    const auto blocked_count = std::count(blocked.begin(), blocked.end(), std::uint8_t{1});
    if (blocked_count != 0 && blocked_count != std::ssize(blocked)) {
      for (int r = 0; r < options.lamp_rays; ++r) {
        if (r % stride != first_probe) add_ray(r);
      }
      trace(scene);
    }
    ray_count = static_cast<float>(rays.size());
  }
};

DirectLight::DirectLight(const RayScene& rays, const Patches& patches, const DirectLightOptions& options)
    : rays_(rays),
      lamps_(patches.lamps, surface_offset(rays.scene())),
      bright_sky_(rays.scene().sky),
      options_(options),
      rays_to_each_light_(rays_to_each_light(rays.scene())),
      offset_(surface_offset(rays.scene())) {}

Rgb DirectLight::at(const SurfacePoint& point, std::uint32_t index, std::span<Rgb> by_group) const {
  thread_local Scratch scratch;
  Rgb sum(0.0F);
  for (std::uint32_t deal = 0; deal < lamps_.deal_count(); ++deal) {
    scratch.clear();
    trace_lamps(point, index, deal, scratch);
    sum += sum_of_free(scratch, by_group);
  }
  scratch.clear();
  trace_lights(point, index, scratch);
  sum += sum_of_free(scratch, by_group);
  scratch.clear();
  trace_sky(point, index, scratch);
  return sum + sum_of_free(scratch, by_group);
}

Rgb DirectLight::sum_of_free(const Scratch& scratch, std::span<Rgb> by_group) const {
  const Scene& scene = rays_.scene();
  glm::dvec3 sum(0.0);
  for (std::size_t r = 0; r < scratch.rays.size(); ++r) {
    if (scratch.blocked[r] != 0) continue;
    const std::uint32_t group = scratch.light_group[r];
    sum += glm::dvec3(scene.dimmers.empty() ? scratch.irradiance[r] : scratch.irradiance[r] * scene.dimmers[group]);
    if (!by_group.empty()) by_group[group] += scratch.irradiance[r] / scratch.ray_count;
  }
  return Rgb(sum) / scratch.ray_count;
}

void DirectLight::trace_lamps(const SurfacePoint& point, std::uint32_t index, std::uint32_t deal,
                              Scratch& scratch) const {
  lamps_.weigh(point, deal, scratch.weights);
  if (!(scratch.weights.total > 0.0)) return;

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
    const std::uint32_t surface = lamps_.tile(chosen.lamp).surface;
    scratch.add({from, (target - from) / distance, free_distance, glm::fract(start.x + step * 0.61803399F)},
                chosen.irradiance, rays_.scene().surfaces[surface].light_group);
  };
  scratch.trace_as_needed(rays_, options_, shift(index, 5), add_ray);
}

void DirectLight::trace_sky(const SurfacePoint& point, std::uint32_t index, Scratch& scratch) const {
  if (bright_sky_.empty() || !(bright_sky_.weigh(point.normal, scratch.sky_weights) > 0.0)) return;
  const glm::vec3 from = point.position + offset_ * point.normal;
  const glm::vec3 start(shift(index, 6), shift(index, 7), shift(index, 8));
  const auto add_ray = [&](int r) {
    const auto step = static_cast<float>(r);
    const double along = (r + double{start.x}) / options_.lamp_rays;
    const glm::vec2 place = glm::fract(glm::vec2(start.y, start.z) + step * glm::vec2(0.75487767F, 0.56984029F));
    const ChosenDirection chosen = bright_sky_.choose(scratch.sky_weights, along, place);
    scratch.add(
        {from, chosen.direction, std::numeric_limits<float>::infinity(), glm::fract(start.x + step * 0.61803399F)},
        chosen.irradiance, rays_.scene().sky.light_group);
  };
  scratch.trace_as_needed(rays_, options_, shift(index, 9), add_ray);
}

void DirectLight::trace_lights(const SurfacePoint& point, std::uint32_t index, Scratch& scratch) const {
  // What each light would bring, and the ray that asks whether it does.
  const glm::vec3 from = point.position + offset_ * point.normal;
  for (const Light& light : rays_.scene().lights) {
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
      scratch.add(ray, irradiance / count, light.light_group);
    }
  }
  scratch.trace(rays_);
}

std::vector<Rgb> direct_on_patches(const DirectLight& direct, const Patches& patches, const Progress& progress,
                                   std::span<Rgb> by_group) {
  std::vector<Rgb> irradiance(patches.patch_count());
  parallel_in_chunks(irradiance.size(), 512, progress, "direct", [&](std::size_t i) {
    const std::span<const SurfacePoint> points = patches.points_of(static_cast<std::uint32_t>(i));
    const auto count = static_cast<float>(points.size());
    const std::size_t groups = by_group.size() / irradiance.size();
    const std::span<Rgb> own = by_group.subspan(i * groups, groups);
    Rgb sum(0.0F);
    for (std::size_t k = 0; k < points.size(); ++k) {
      sum += direct.at(points[k], static_cast<std::uint32_t>(i * points.size() + k), own);
    }
    irradiance[i] = sum / count;
    for (Rgb& light : own) light /= count;
  });
  return irradiance;
}

}  // namespace radiosity
