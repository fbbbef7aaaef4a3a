#include "plugin/import_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec4.hpp>
#include <numbers>
#include <string>

#include "plugin/check_document.h"

namespace gltf_radiosity {
namespace {

/// Lumen per watt at 555 nm, which Blender's exporter takes for the efficacy of every light.
constexpr float kBlenderLumenPerWatt = 683.0F;

constexpr double kQuarterTurn = std::numbers::pi / 2.0;

bool is_from_blender(const Json& root) {
  const auto generator = root["asset"].value("generator", "");
  return generator.find("Khronos") != std::string::npos && generator.find("Blender") != std::string::npos;
}

bool has_punctual_lights(const Json& root) {
  const Json* extension = extension_of(root, "KHR_lights_punctual");
  return extension != nullptr && !array_of(*extension, "lights").empty();
}

}  // namespace

float light_unit_factor(const Document& document, LightUnits units, std::vector<Warning>& warnings) {
  if (units == LightUnits::kSi) return 1.0F;
  if (units == LightUnits::kBlender) return 1.0F / kBlenderLumenPerWatt;
  if (!is_from_blender(document.json) || !has_punctual_lights(document.json)) return 1.0F;
  warnings.push_back(
      {"blender-light-units", "asset.generator",
       "Blender's exporter writes lights 683 times too bright beside its emission; they were divided by 683 "
       "(--light-units si keeps them)"});
  return 1.0F / kBlenderLumenPerWatt;
}

radiosity::Light import_light(const Json& light, const glm::dmat4& world_from_node, float unit_factor) {
  using Kind = radiosity::Light::Kind;
  radiosity::Light result;
  const auto type = light["type"].get<std::string>();
  result.kind = type == "spot" ? Kind::kSpot : type == "directional" ? Kind::kDirectional : Kind::kPoint;

  // Place.
  result.position = glm::vec3(world_from_node[3]);
  const glm::dvec3 along = -glm::dvec3(world_from_node[2]);
  const double length = glm::length(along);
  if (length > 0.0 && std::isfinite(length)) result.direction = glm::vec3(along / length);

  // Strength.
  result.intensity = color_of_light(light) * (std::max(light.value("intensity", 1.0F), 0.0F) * unit_factor);
  if (result.kind != Kind::kDirectional) result.range = std::max(light.value("range", 0.0F), 0.0F);

  // Cone: 0 <= inner < outer <= a quarter turn.
  const Json spot = light.value("spot", Json::object());
  const double outer = std::clamp(spot.value("outerConeAngle", kQuarterTurn / 2.0), 0.0, kQuarterTurn);
  const double inner = std::clamp(spot.value("innerConeAngle", 0.0), 0.0, outer);
  result.outer_cone_cos = static_cast<float>(std::cos(outer));
  result.inner_cone_cos = static_cast<float>(std::cos(inner));
  return result;
}

radiosity::Rgb color_of_light(const Json& light) {
  radiosity::Rgb result(1.0F);
  const auto color = light.find("color");
  if (color == light.end()) return result;
  for (int band = 0; band < 3; ++band) {
    result[band] = std::max((*color)[static_cast<std::size_t>(band)].get<float>(), 0.0F);
  }
  return result;
}

radiosity::Rgb strength_of_light(const Json& light) { return import_light(light, glm::dmat4(1.0), 1.0F).intensity; }

radiosity::Light import_sun(const Sun& sun) {
  const double elevation = glm::radians(sun.elevation_degrees), azimuth = glm::radians(sun.azimuth_degrees);
  const glm::dvec3 towards(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                           std::cos(elevation) * std::cos(azimuth));
  radiosity::Light light;
  light.kind = radiosity::Light::Kind::kDirectional;
  light.direction = glm::vec3(-towards);
  light.intensity = radiosity::Rgb(static_cast<float>(sun.illuminance_lux));
  return light;
}

}  // namespace gltf_radiosity
