// The light at the vertices under other lights, or between surfaces that reflect otherwise: transport that is known.
//
// Gives what a bake of the changed scene gives on the same mesh, but for rounding and what a solver leaves unshot.
#pragma once

#include <span>
#include <vector>

#include "core/light_transport.h"
#include "core/progress.h"

namespace radiosity {

/// H at each vertex, lx, never negative, where each light group is multiplied by its dimmer, [group_count].
std::vector<Rgb> relight(const LightTransport& transport, std::span<const Rgb> dimmers);

/// The same where patches have these reflectances, [patch_count], each at most kMaxReflectance. REQUIRES:
/// transport.has_rows(). Throws `Cancelled`.
std::vector<Rgb> relight(const LightTransport& transport, std::span<const Rgb> dimmers,
                         std::span<const Rgb> reflectance, const Progress& progress);

}  // namespace radiosity
