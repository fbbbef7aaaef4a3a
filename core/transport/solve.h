// What both solvers are given and what they return.
//
// The radiosity equation between patches, per band: B_i = E_i + rho_i (H_i + sum_j F_ij B_j), where H_i is the direct
// light of everything that has no patch of its own or was taken out first: lamps and punctual lights by shadow rays,
// and the sky. E_i is the glow that was not taken out.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/patches.h"
#include "core/progress.h"
#include "core/transport/form_factors.h"

namespace radiosity {

struct SolveProblem {
  const Patches& patches;
  std::span<const Rgb> direct;    ///< H_i, [patch_count], lx
  float residual = 0.001F;        ///< stop when at most this share of the emitted flux is unshot
  double reserved_seconds = 0.0;  ///< what is to be left of Progress::seconds_left
};

struct Solution {
  std::vector<Rgb> radiosity;   ///< B_i, lamps' own exitance left out, [patch_count], lm/m2
  std::vector<Rgb> irradiance;  ///< what arrives from other patches, H_i left out, [patch_count], lx
  float residual = 0.0F;        ///< share of the emitted flux still unshot (or the last sweep's change of it)
  std::uint32_t steps = 0;      ///< shots, or patches gathered to
  bool converged = false;       ///< false only where the step limit or the time ended it
  bool out_of_time = false;     ///< what there was when time was up
};

/// What patches send before light is exchanged: E_i + rho_i H_i, lm/m2, [patch_count].
std::vector<glm::dvec3> first_radiosity(const SolveProblem& problem);

/// Flux of a radiosity over the patches, eye-weighted, lm.
double flux_of(const Patches& patches, std::span<const glm::dvec3> radiosity);

/// Area-weighted mean reflectance.
glm::dvec3 mean_reflectance(const Patches& patches);

}  // namespace radiosity
