// The only place with a pi between luminance, exitance, irradiance and radiosity.
#pragma once

#include <numbers>

#include "core/scene.h"

namespace radiosity {

inline constexpr float kPi = std::numbers::pi_v<float>;

/// A diffuse surface that leaves B lm/m2 shows B / pi cd/m2 in every direction.
constexpr Rgb luminance_of_radiosity(const Rgb& radiosity) { return radiosity * (1.0F / kPi); }

/// A diffuse surface that shows Le cd/m2 leaves pi Le lm/m2.
constexpr Rgb exitance_of_luminance(const Rgb& luminance) { return luminance * kPi; }

/// Directions that fill the share `form_factor` of a receiver's view and show `luminance` bring this irradiance, lx.
constexpr Rgb irradiance_of_luminance(const Rgb& luminance, float form_factor) {
  return luminance * (kPi * form_factor);
}

/// What a diffuse surface shows under irradiance H: rho H / pi, cd/m2.
constexpr Rgb reflected_luminance(const Rgb& reflectance, const Rgb& irradiance) {
  return reflectance * irradiance * (1.0F / kPi);
}

}  // namespace radiosity
