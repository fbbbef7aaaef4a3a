// Skies with a map, from a function of the direction.
#pragma once

#include <cstddef>

#include "core/sky.h"

namespace radiosity::test {

/// A map `width` x `width / 2` whose texels show `luminance` of their middle direction.
template <typename Luminance>
Sky sky_of(int width, const Luminance& luminance) {
  Sky sky;
  sky.width = width;
  sky.height = width / 2;
  sky.map.resize(static_cast<std::size_t>(sky.width) * static_cast<std::size_t>(sky.height));
  for (std::size_t texel = 0; texel < sky.map.size(); ++texel) {
    sky.map[texel] = Rgb(luminance(direction_in_texel(sky, texel, {0.5F, 0.5F})));
  }
  return sky;
}

/// Makes the texel in a direction a sun of `lux` on a surface that faces it. Answers its index.
inline std::size_t add_sun(Sky& sky, const glm::vec3& direction, const Rgb& lux) {
  const std::size_t texel = texel_towards(sky, direction);
  const auto row = static_cast<int>(texel / static_cast<std::size_t>(sky.width));
  sky.map[texel] = lux / static_cast<float>(texel_solid_angle(sky, row));
  return texel;
}

/// Integral over the sphere of `value(direction)`, by the middles of many small texels.
template <typename Value>
glm::dvec3 integral(const Value& value) {
  const Sky grid = sky_of(256, [](const glm::vec3&) { return 0.0F; });
  glm::dvec3 sum(0.0);
  for (std::size_t texel = 0; texel < grid.map.size(); ++texel) {
    const int row = static_cast<int>(texel) / grid.width;
    sum += texel_solid_angle(grid, row) * glm::dvec3(value(direction_in_texel(grid, texel, {0.5F, 0.5F})));
  }
  return sum;
}

}  // namespace radiosity::test
