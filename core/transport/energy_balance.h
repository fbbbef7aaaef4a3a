// Where the flux went: a check on the solution, and a figure for the report.
#pragma once

#include "core/transport/solve.h"

namespace radiosity {

/// Fluxes in lumen, eye-weighted. What is emitted is absorbed or escapes, up to the residual and the errors of the form
/// factors.
struct EnergyBalance {
  double emitted = 0.0;   ///< what lamps, lights and sky bring onto the patches, and what these emit themselves
  double absorbed = 0.0;  ///< what the patches do not reflect
  double escaped = 0.0;   ///< what leaves into the open or onto backs that send no light
};

/// Rows that are no longer cached are left out of `escaped`.
EnergyBalance energy_balance(const SolveProblem& problem, const Solution& solution, RowCache& rows);

}  // namespace radiosity
