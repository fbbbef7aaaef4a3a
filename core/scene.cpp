#include "core/scene.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace radiosity {
namespace {

/// Surface offset as a share of the scene's diagonal: a tenth of a millimetre in a room 10 m across.
constexpr float kOffsetPerDiagonal = 2e-5F;

/// Surface offset in rounding steps of the largest coordinate. Far from the origin positions are coarse, and a hit
/// point computed from them is off by a few such steps.
constexpr float kOffsetInRoundingSteps = 8.0F;

bool is_share(const Rgb& v) { return is_light(v) && v.x <= 1.0F && v.y <= 1.0F && v.z <= 1.0F; }

std::string place(const char* array, std::size_t index) {
  return std::string(array) + "[" + std::to_string(index) + "]";
}

std::optional<std::string> validate_vertices(const Scene& scene) {
  if (scene.normals.size() != scene.positions.size()) {
    return "there are not as many normals as positions";
  }
  if (scene.positions.size() >= kNothing) {
    return "there are too many vertices";
  }
  for (std::size_t i = 0; i < scene.positions.size(); ++i) {
    if (!is_in_reach(scene.positions[i])) {
      return place("positions", i) + " is not finite, or beyond 1e8 m";
    }
    if (!is_finite(scene.normals[i])) {
      return place("normals", i) + " is not finite";
    }
  }
  return std::nullopt;
}

std::optional<std::string> validate_triangles(const Scene& scene) {
  if (scene.surface_of_triangle.size() != scene.triangles.size()) {
    return "there are not as many surface indices as triangles";
  }
  if (scene.triangles.size() >= kNothing) {
    return "there are too many triangles";
  }
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    const glm::uvec3& corners = scene.triangles[i];
    if (std::max({corners.x, corners.y, corners.z}) >= scene.positions.size()) {
      return place("triangles", i) + " names a vertex that does not exist";
    }
    if (scene.surface_of_triangle[i] >= scene.surfaces.size()) {
      return place("triangles", i) + " names a surface that does not exist";
    }
  }
  return std::nullopt;
}

std::optional<std::string> validate_surfaces(const Scene& scene) {
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    const Surface& surface = scene.surfaces[i];
    if (!is_share(surface.reflectance)) {
      return place("surfaces", i) + " has a reflectance outside [0,1]";
    }
    if (!is_light(surface.emission)) {
      return place("surfaces", i) + " has an emission that is negative or not finite";
    }
    if ((surface.varies || surface.see_through) && scene.detail == nullptr) {
      return place("surfaces", i) + " varies, but the scene has no detail";
    }
  }
  return std::nullopt;
}

std::optional<std::string> validate_lights(const Scene& scene) {
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (!is_light(light.intensity)) {
      return place("lights", i) + " has an intensity that is negative or not finite";
    }
    if (light.kind != Light::Kind::kDirectional && !is_in_reach(light.position)) {
      return place("lights", i) + " has a position that is not finite, or beyond 1e8 m";
    }
    if (light.kind != Light::Kind::kPoint && !(std::abs(glm::length(light.direction) - 1.0F) < 1e-3F)) {
      return place("lights", i) + " has a direction that is not of unit length";
    }
    if (!(light.range >= 0.0F)) {
      return place("lights", i) + " has a negative range";
    }
    if (light.kind == Light::Kind::kSpot && !(light.inner_cone_cos >= light.outer_cone_cos)) {
      return place("lights", i) + " has an inner cone wider than its outer cone";
    }
  }
  return std::nullopt;
}

std::optional<std::string> validate_sky(const Scene& scene) { return validate(scene.sky); }

std::optional<std::string> validate_groups(const Scene& scene) {
  if (!scene.dimmers.empty() && scene.dimmers.size() < light_group_count(scene)) {
    return "there are not as many dimmers as light groups";
  }
  for (std::size_t i = 0; i < scene.dimmers.size(); ++i) {
    if (!is_light(scene.dimmers[i])) return place("dimmers", i) + " is negative or not finite";
  }
  return std::nullopt;
}

const Surface& surface_of(const Scene& scene, std::uint32_t triangle) {
  return scene.surfaces[scene.surface_of_triangle[triangle]];
}

}  // namespace

std::optional<std::string> validate(const Scene& scene) {
  for (const auto check :
       {validate_vertices, validate_triangles, validate_surfaces, validate_lights, validate_sky, validate_groups}) {
    if (auto wrong = check(scene)) {
      return wrong;
    }
  }
  return std::nullopt;
}

std::uint32_t light_group_count(const Scene& scene) {
  std::uint32_t last = scene.sky.light_group;
  for (const Surface& surface : scene.surfaces) last = std::max(last, surface.light_group);
  for (const Light& light : scene.lights) last = std::max(last, light.light_group);
  return std::max(last + 1, static_cast<std::uint32_t>(scene.dimmers.size()));
}

Rgb dimmer_of(const Scene& scene, std::uint32_t light_group) {
  return scene.dimmers.empty() ? Rgb(1.0F) : scene.dimmers[light_group];
}

float diagonal(const Scene& scene) {
  if (scene.positions.empty()) {
    return 0.0F;
  }
  glm::vec3 low = scene.positions.front();
  glm::vec3 high = low;
  for (const glm::vec3& position : scene.positions) {
    low = glm::min(low, position);
    high = glm::max(high, position);
  }
  return glm::distance(low, high);
}

float surface_offset(const Scene& scene) {
  float largest_coordinate = 0.0F;
  for (const glm::vec3& position : scene.positions) {
    const glm::vec3 size = glm::abs(position);
    largest_coordinate = std::max({largest_coordinate, size.x, size.y, size.z});
  }
  const float rounding_step = largest_coordinate * std::numeric_limits<float>::epsilon();
  return std::max(kOffsetPerDiagonal * diagonal(scene), kOffsetInRoundingSteps * rounding_step);
}

glm::vec3 scaled_normal(const Scene& scene, std::uint32_t triangle) {
  const glm::uvec3& corners = scene.triangles[triangle];
  const glm::vec3& a = scene.positions[corners.x];
  return glm::cross(scene.positions[corners.y] - a, scene.positions[corners.z] - a);
}

glm::vec3 point_at(const Scene& scene, std::uint32_t triangle, Barycentrics at) {
  const glm::uvec3& corners = scene.triangles[triangle];
  return scene.positions[corners.x] * (1.0F - at.x - at.y) + scene.positions[corners.y] * at.x +
         scene.positions[corners.z] * at.y;
}

Rgb mean_reflectance(const Scene& scene, std::uint32_t triangle, const SubTriangle& part) {
  const Surface& surface = surface_of(scene, triangle);
  const Rgb reflectance = surface.varies ? scene.detail->reflectance(triangle, part) : surface.reflectance;
  return glm::clamp(reflectance, 0.0F, kMaxReflectance);
}

Rgb undyed_reflectance(const Scene& scene, std::uint32_t triangle, const SubTriangle& part) {
  const Surface& surface = surface_of(scene, triangle);
  return surface.varies ? scene.detail->undyed_reflectance(triangle, part) : surface.undyed_reflectance;
}

Rgb mean_emission(const Scene& scene, std::uint32_t triangle, const SubTriangle& part) {
  const Surface& surface = surface_of(scene, triangle);
  const Rgb emission = surface.varies ? scene.detail->emission(triangle, part) : surface.emission;
  return glm::max(emission, Rgb(0.0F));
}

Rgb shown_emission(const Scene& scene, std::uint32_t triangle, const SubTriangle& part) {
  return mean_emission(scene, triangle, part) * dimmer_of(scene, surface_of(scene, triangle).light_group);
}

float undyed_brightness(const Surface& surface, const Rgb& emission) {
  if (!surface.varies || surface.emission == Rgb(0.0F)) return luminance_of(emission);
  Rgb pattern(0.0F);
  for (int band = 0; band < 3; ++band) {
    if (surface.emission[band] > 0.0F) pattern[band] = emission[band] / surface.emission[band];
  }
  return luminance_of(pattern);
}

Rgb sky_luminance(const Scene& scene, const glm::vec3& direction) { return luminance_towards(scene.sky, direction); }

bool lets_through(const Scene& scene, std::uint32_t triangle, Barycentrics at, float threshold) {
  if (!surface_of(scene, triangle).see_through) {
    return false;
  }
  // Layers one behind another must not all stop the same rays: each shifts the threshold by a share of its own.
  const float shift = static_cast<float>((triangle * 0x9E3779B9U) >> 8U) * 0x1p-24F;
  const float shifted = threshold + shift;
  return scene.detail->opacity(triangle, at) <= (shifted < 1.0F ? shifted : shifted - 1.0F);
}

}  // namespace radiosity
