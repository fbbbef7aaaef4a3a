#include "core/sky.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>

#include "core/photometry.h"

namespace radiosity {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Latitude of the upper edge of a row, rad.
double latitude_above(const Sky& sky, int row) {
  return std::numbers::pi * (0.5 - static_cast<double>(row) / sky.height);
}

/// Longitude of the left edge of a column, from +x towards +z, rad.
double longitude_before(const Sky& sky, int column) { return kTwoPi * (static_cast<double>(column) / sky.width - 0.5); }

int row_of(const Sky& sky, std::size_t texel) { return static_cast<int>(texel / static_cast<std::size_t>(sky.width)); }
int column_of(const Sky& sky, std::size_t texel) {
  return static_cast<int>(texel % static_cast<std::size_t>(sky.width));
}

}  // namespace

std::optional<std::string> validate(const Sky& sky) {
  if (!is_light(sky.luminance)) return "the sky is negative or not finite";
  if (!sky.has_map()) return std::nullopt;
  const bool sized = sky.width > 0 && sky.height > 0 &&
                     sky.map.size() == static_cast<std::size_t>(sky.width) * static_cast<std::size_t>(sky.height);
  if (!sized) return "the sky's map is not as large as it says";
  if (!std::all_of(sky.map.begin(), sky.map.end(), is_light)) return "the sky's map is negative or not finite";
  const glm::mat3 product = sky.map_from_world * glm::transpose(sky.map_from_world);
  for (int k = 0; k < 9; ++k) {
    const float identity = k % 4 == 0 ? 1.0F : 0.0F;
    if (!(std::abs(product[k / 3][k % 3] - identity) < 1e-3F)) return "the sky is not turned by a rotation";
  }
  return std::nullopt;
}

Rgb luminance_towards(const Sky& sky, const glm::vec3& direction) {
  return sky.has_map() ? sky.map[texel_towards(sky, direction)] : sky.luminance;
}

Rgb mean_luminance(const Sky& sky) {
  if (!sky.has_map()) return sky.luminance;
  glm::dvec3 sum(0.0);
  for (int row = 0; row < sky.height; ++row) {
    glm::dvec3 row_sum(0.0);
    for (int column = 0; column < sky.width; ++column) {
      row_sum += glm::dvec3(sky.map[static_cast<std::size_t>(row) * static_cast<std::size_t>(sky.width) +
                                    static_cast<std::size_t>(column)]);
    }
    sum += row_sum * texel_solid_angle(sky, row);
  }
  return Rgb(sum / (2.0 * kTwoPi));
}

glm::mat3 map_turned_by(double degrees) {
  const double angle = glm::radians(degrees);
  const auto cosine = static_cast<float>(std::cos(angle)), sine = static_cast<float>(std::sin(angle));
  return {glm::vec3(cosine, 0.0F, sine), glm::vec3(0.0F, 1.0F, 0.0F), glm::vec3(-sine, 0.0F, cosine)};
}

std::size_t texel_towards(const Sky& sky, const glm::vec3& direction) {
  const glm::vec3 d = sky.map_from_world * direction;
  const float u = std::atan2(d.z, d.x) / (2.0F * kPi) + 0.5F;
  const float v = 0.5F - std::asin(std::clamp(d.y, -1.0F, 1.0F)) / kPi;
  const int column = std::clamp(static_cast<int>(u * static_cast<float>(sky.width)), 0, sky.width - 1);
  const int row = std::clamp(static_cast<int>(v * static_cast<float>(sky.height)), 0, sky.height - 1);
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(sky.width) + static_cast<std::size_t>(column);
}

double texel_solid_angle(const Sky& sky, int row) {
  return kTwoPi / sky.width * (std::sin(latitude_above(sky, row)) - std::sin(latitude_above(sky, row + 1)));
}

glm::dvec3 texel_vector(const Sky& sky, std::size_t texel) {
  // The integral of (cos^2 phi cos theta, cos phi sin phi, cos^2 phi sin theta) over latitude phi and longitude theta.
  const double above = latitude_above(sky, row_of(sky, texel)), below = latitude_above(sky, row_of(sky, texel) + 1);
  const double before = longitude_before(sky, column_of(sky, texel)),
               after = longitude_before(sky, column_of(sky, texel) + 1);
  const auto squared_cosine = [](double phi) { return 0.5 * phi + 0.25 * std::sin(2.0 * phi); };
  const double level = squared_cosine(above) - squared_cosine(below);
  const double sine_above = std::sin(above), sine_below = std::sin(below);
  const double upward = 0.5 * (sine_above * sine_above - sine_below * sine_below);
  const glm::dvec3 on_map(level * (std::sin(after) - std::sin(before)), upward * (after - before),
                          level * (std::cos(before) - std::cos(after)));
  return glm::transpose(glm::dmat3(sky.map_from_world)) * on_map;
}

glm::vec3 direction_in_texel(const Sky& sky, std::size_t texel, const glm::vec2& place) {
  const int row = row_of(sky, texel), column = column_of(sky, texel);
  const double above = std::sin(latitude_above(sky, row)), below = std::sin(latitude_above(sky, row + 1));
  const double y = above + double{place.y} * (below - above);
  const double longitude = longitude_before(sky, column) + double{place.x} * kTwoPi / sky.width;
  const double level = std::sqrt(std::max(0.0, 1.0 - y * y));
  const glm::dvec3 on_map(level * std::cos(longitude), y, level * std::sin(longitude));
  return glm::vec3(glm::transpose(glm::dmat3(sky.map_from_world)) * on_map);
}

}  // namespace radiosity
