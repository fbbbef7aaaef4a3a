// What stands around the scene: the luminance of every direction that hits nothing.
//
// The same all around, or an equirectangular map: rows are latitudes from straight up to straight down, columns
// longitudes. Seen from inside and not turned, +x is its middle and +z is to the right of that, as in three.js:
//
//      -x          -z          +x          +z          -x
//       +-----------+-----------+-----------+-----------+  +y
//       |           |           |           |           |
//       |-----------|-----------|-----------|-----------|  horizon
//       |           |           |           |           |
//       +-----------+-----------+-----------+-----------+  -y
//      270         180         90           0          -90    azimuth in degrees, as for a sun at (sin az, 0, cos az)
//
// A texel has one luminance all over, so that what a map sends is a plain sum over texels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/rgb.h"

namespace radiosity {

struct Sky {
  Rgb luminance{0.0F};             ///< of every direction, cd/m2; unused if there is a map
  int width = 0, height = 0;       ///< texels of the map
  std::vector<Rgb> map;            ///< [height * width], cd/m2, rows from +y down; empty: no map
  glm::mat3 map_from_world{1.0F};  ///< a rotation: world directions to those of the picture above
  std::uint32_t light_group = 0;

  bool has_map() const { return !map.empty(); }
};

/// Says what is wrong with a sky, or nothing.
std::optional<std::string> validate(const Sky& sky);

/// Luminance in a direction (unit, world space), cd/m2.
Rgb luminance_towards(const Sky& sky, const glm::vec3& direction);

/// Mean luminance over the sphere, cd/m2.
Rgb mean_luminance(const Sky& sky);

/// The map's rotation about +y that moves what stands at azimuth a to a + `degrees`.
glm::mat3 map_turned_by(double degrees);

// A map's texels, by their index in Sky::map. REQUIRES: there is a map.

std::size_t texel_towards(const Sky& sky, const glm::vec3& direction);
/// Solid angle of the texels of a row, sr. All rows together fill the sphere.
double texel_solid_angle(const Sky& sky, int row);
/// Integral of the (world) direction over a texel, sr: times a normal and a luminance it is an irradiance.
glm::dvec3 texel_vector(const Sky& sky, std::size_t texel);
/// The direction (world, unit) at a place in [0,1)^2 of a texel; evenly spread places give evenly spread directions.
glm::vec3 direction_in_texel(const Sky& sky, std::size_t texel, const glm::vec2& place);

}  // namespace radiosity
