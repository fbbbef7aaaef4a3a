// Gathering: each patch collects from all others over stored rows, again and again (Gauss-Seidel).
//
// Goral, Torrance, Greenberg and Battaile. Modeling the Interaction of Light Between Diffuse Surfaces. 1984
// Needs every row of F; the reference for solve_progressive.h, and cheap once the rows are there.
#pragma once

#include "core/transport/solve.h"

namespace radiosity {

/// Sweeps until what is still to come is at most `problem.residual` of the emitted flux. Throws `Cancelled`.
Solution solve_gathering(const SolveProblem& problem, RowCache& rows, const Progress& progress);

}  // namespace radiosity
