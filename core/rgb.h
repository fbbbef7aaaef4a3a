// Three linear Rec. 709 bands, the form that all light takes here.
#pragma once

#include <glm/vec3.hpp>

#include "core/finite.h"

namespace radiosity {

/// A quantity in the three linear Rec. 709 bands (red, green, blue).
using Rgb = glm::vec3;

/// The three bands as the eye weighs them (Rec. 709).
constexpr float luminance_of(const Rgb& rgb) { return 0.2126F * rgb.x + 0.7152F * rgb.y + 0.0722F * rgb.z; }

/// Whether `rgb` can be an amount of light: finite and not negative in each band.
inline bool is_light(const Rgb& rgb) { return is_finite(rgb) && rgb.x >= 0.0F && rgb.y >= 0.0F && rgb.z >= 0.0F; }

}  // namespace radiosity
