// A scene of four light groups, and how far apart two lights of its vertices are.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <vector>

#include "core/bake.h"
#include "tests/core/same_bytes.h"
#include "tests/core/test_scenes.h"

namespace radiosity::test {

enum Group : std::uint32_t { kLamp, kGlowingBlock, kBulb, kSky, kGroupCount };

/// The Cornell box with a lamp, a block that glows, a bulb and an open front, each a light group.
inline Scene four_lights() {
  Scene scene = cornell_box();
  constexpr std::size_t kTopOfShortBlock = 10;
  scene.surfaces.push_back({.reflectance = Rgb(0.5F), .emission = {0.5F, 2.0F, 6.0F}, .light_group = kGlowingBlock});
  scene.surface_of_triangle[kTopOfShortBlock] = scene.surface_of_triangle[kTopOfShortBlock + 1] = 4;
  scene.lights = {
      {.position = {0.1F, 0.4F, 0.1F}, .intensity = {0.5F, 0.3F, 0.1F}, .range = 2.0F, .light_group = kBulb}};
  scene.sky.luminance = {0.1F, 0.2F, 0.3F};
  scene.sky.light_group = kSky;
  return scene;
}

inline BakeOptions quick_groups() {
  BakeOptions options;
  options.subdivide.patch_size = 0.12F;
  options.max_patches = 200;
  options.visibility = Visibility::kRays;
  options.light_groups = true;
  return options;
}

/// Root mean square over the vertices of the difference, relative to the mean of `b`.
inline double rms_difference(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
  double square = 0.0, sum = 0.0;
  for (std::size_t v = 0; v < a.size(); ++v) {
    const auto apart = static_cast<double>(glm::length(a[v] - b[v]));
    square += apart * apart;
    sum += static_cast<double>(glm::length(b[v]));
  }
  const auto count = static_cast<double>(a.size());
  return std::sqrt(square / count) / (sum / count);
}

}  // namespace radiosity::test
