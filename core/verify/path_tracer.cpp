#include "core/verify/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/photometry.h"

namespace radiosity {
namespace {

constexpr int kBouncesBeforeRoulette = 3;
constexpr std::size_t kMaxLightRays = 4;  ///< to punctual lights, at each bounce

/// How much a sample counts that was drawn with `density`, where another technique would have drawn it with `other`.
float power_weight(float density, float other) {
  const float square = density * density;
  return square > 0.0F ? square / (square + other * other) : 0.0F;
}

float largest(const Rgb& v) { return std::max({v.x, v.y, v.z}); }

/// A textured surface at one point.
SubTriangle point_part(Barycentrics at) { return {{at, at, at}}; }

/// What a punctual light brings to a place if nothing is in the way.
struct Arriving {
  Rgb irradiance{0.0F};  ///< lx
  Ray ray;               ///< towards the light
};

/// Distance, range and cone as KHR_lights_punctual defines them.
Arriving arriving_from(const Light& light, const glm::vec3& position, const glm::vec3& normal) {
  Arriving result{light.intensity, {position, -light.direction}};
  if (light.kind != Light::Kind::kDirectional) {
    const glm::vec3 to_light = light.position - position;
    const float distance = std::max(glm::length(to_light), 1e-6F);
    result.ray.direction = to_light / distance;
    result.ray.length = distance;
    result.irradiance /= distance * distance;
    if (light.range > 0.0F) {
      const float ratio = distance / light.range;
      result.irradiance *= std::clamp(1.0F - ratio * ratio * ratio * ratio, 0.0F, 1.0F);
    }
  }
  if (light.kind == Light::Kind::kSpot) {
    const float cosine = -glm::dot(light.direction, result.ray.direction);
    const float width = std::max(light.inner_cone_cos - light.outer_cone_cos, 0.001F);
    const float share = std::clamp((cosine - light.outer_cone_cos) / width, 0.0F, 1.0F);
    result.irradiance *= share * share;
  }
  result.irradiance *= std::max(glm::dot(normal, result.ray.direction), 0.0F);
  return result;
}

}  // namespace

PathTracer::PathTracer(const RayScene& rays)
    : rays_(rays), scene_(rays.scene()), emitters_(rays.scene()), offset_(surface_offset(rays.scene())) {}

PathSample PathTracer::sample(const glm::vec3& position, const glm::vec3& normal, Random& random) const {
  PathSample result;
  Rgb throughput(1.0F);  // irradiance here that comes of irradiance there
  Place place{position + offset_ * normal, normal};
  for (int bounce = 0;; ++bounce) {
    // Aimed at light.
    result.irradiance += throughput * (from_emitters(place, random) + from_lights(place, random));

    // Aimed anywhere.
    const Ray ray{place.position, cosine_direction(place.normal, random)};
    const std::optional<Hit> hit = nearest_hit(rays_, ray, [&random] { return random.share(); });
    if (!hit) {
      result.irradiance += throughput * exitance_of_luminance(sky_luminance(scene_, ray.direction));
      return result;
    }
    if (hit->back && !scene_.surfaces[scene_.surface_of_triangle[hit->triangle]].two_sided) {
      result.sees_back = bounce == 0;
      return result;
    }
    result.irradiance += throughput * found_emission(place, ray, *hit);

    // Onwards, or not: paths that carry little end early, and the survivors stand for them.
    throughput *= mean_reflectance(scene_, hit->triangle, point_part(hit->at));
    const float survival = bounce < kBouncesBeforeRoulette ? 1.0F : std::min(largest(throughput), 1.0F);
    if (!(largest(throughput) > 0.0F) || random.share() >= survival) return result;
    throughput /= survival;
    place = place_of(ray, *hit);
  }
}

PathTracer::Place PathTracer::place_of(const Ray& ray, const Hit& hit) const {
  const glm::vec3 front = glm::normalize(scaled_normal(scene_, hit.triangle));
  const glm::vec3 normal = glm::dot(front, ray.direction) > 0.0F ? -front : front;
  return {point_at(scene_, hit.triangle, hit.at) + offset_ * normal, normal};
}

Rgb PathTracer::found_emission(const Place& place, const Ray& ray, const Hit& hit) const {
  const Rgb luminance = mean_emission(scene_, hit.triangle, point_part(hit.at));
  if (luminance == Rgb(0.0F)) return luminance;
  const float cosine = std::max(glm::dot(place.normal, ray.direction), 0.0F);
  const glm::vec3 front = glm::normalize(scaled_normal(scene_, hit.triangle));
  const float emitter_cosine = std::max(std::abs(glm::dot(front, ray.direction)), 1e-9F);
  const float aimed = emitters_.density(hit.triangle) * hit.distance * hit.distance / emitter_cosine;
  return exitance_of_luminance(luminance) * power_weight(cosine / kPi, aimed);
}

Rgb PathTracer::from_emitters(const Place& place, Random& random) const {
  if (emitters_.empty()) return Rgb(0.0F);
  const EmitterPlace chosen = emitters_.choose(random);
  const glm::vec3 to_emitter = point_at(scene_, chosen.triangle, chosen.at) - place.position;
  const float distance = glm::length(to_emitter);
  if (!(distance > 2.0F * offset_)) return Rgb(0.0F);
  const glm::vec3 direction = to_emitter / distance;

  // Both sides must face each other.
  const bool two_sided = scene_.surfaces[scene_.surface_of_triangle[chosen.triangle]].two_sided;
  const float towards = -glm::dot(glm::normalize(scaled_normal(scene_, chosen.triangle)), direction);
  const float emitter_cosine = two_sided ? std::abs(towards) : towards;
  const float cosine = glm::dot(place.normal, direction);
  if (!(cosine > 0.0F && emitter_cosine > 0.0F)) return Rgb(0.0F);

  // The ray ends just before the emitter.
  const float length = distance * (1.0F - 1e-4F) - offset_;
  if (is_blocked(rays_, {place.position, direction, length}, [&random] { return random.share(); })) return Rgb(0.0F);
  const float aimed = emitters_.density(chosen.triangle) * distance * distance / emitter_cosine;
  const Rgb luminance = mean_emission(scene_, chosen.triangle, point_part(chosen.at));
  return luminance * (cosine / aimed * power_weight(aimed, cosine / kPi));
}

Rgb PathTracer::from_lights(const Place& place, Random& random) const {
  // What all would bring.
  float total = 0.0F;
  for (const Light& light : scene_.lights) {
    total += luminance_of(arriving_from(light, place.position, place.normal).irradiance);
  }
  if (!(total > 0.0F)) return Rgb(0.0F);

  // Rays at even steps along that sum: a light gets as many as is its share.
  const float step = total / static_cast<float>(std::min(scene_.lights.size(), kMaxLightRays));
  float next = random.share() * step;
  float passed = 0.0F;
  Rgb sum(0.0F);
  for (const Light& light : scene_.lights) {
    Arriving arriving = arriving_from(light, place.position, place.normal);
    const float share = luminance_of(arriving.irradiance);
    passed += share;
    float ray_count = 0.0F;
    for (; next < passed; next += step) ray_count += 1.0F;
    if (ray_count == 0.0F) continue;
    arriving.ray.length *= 1.0F - 1e-4F;
    if (is_blocked(rays_, arriving.ray, [&random] { return random.share(); })) continue;
    sum += arriving.irradiance * (ray_count * step / share);
  }
  return sum;
}

}  // namespace radiosity
