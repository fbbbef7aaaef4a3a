// Progressive refinement: the patch with the most unshot flux sends it to all others; repeat.
//
// Cohen, Chen, Wallace and Greenberg. A Progressive Refinement Approach to Fast Radiosity Image Generation. 1988
#pragma once

#include "core/transport/solve.h"

namespace radiosity {

/// Shoots until at most `problem.residual` of the emitted flux is unshot; what remains is spread by the ambient
/// estimate. Then the patches that have shot gather a few times: shooting reads what reaches a patch from the rows
/// of others, and a few hemicubes there do not say well what reaches its neighbour in a corner. Rows of F are fetched
/// for the next few shooters side by side. Deterministic for any number of threads. Throws `Cancelled`.
Solution solve_progressive(const SolveProblem& problem, RowCache& rows, const Progress& progress);

/// The ambient estimate (lm/m2): the irradiance that unshot radiosity would bring if it were spread evenly over all
/// surfaces and reflected on and on: sum(A unshot) / sum(A) / (1 - mean reflectance).
Rgb ambient_estimate(const Patches& patches, std::span<const glm::dvec3> unshot);

}  // namespace radiosity
