// Gathering: each patch collects from all others over stored rows, again and again (Gauss-Seidel).
//
// Goral, Torrance, Greenberg and Battaile. Modeling the Interaction of Light Between Diffuse Surfaces. 1984
// Needs every row of F; the reference for solve_progressive.h, and cheap once the rows are there.
#pragma once

#include "core/transport/solve.h"

namespace radiosity {

/// Sweeps until what is still to come is at most `problem.residual` of the emitted flux. Throws `Cancelled`.
Solution solve_gathering(const SolveProblem& problem, RowCache& rows, const Progress& progress);

/// The light of each light group for itself, before it is dimmed.
struct GroupProblem {
  const Patches& patches;
  std::uint32_t group_count = 0;
  std::span<const Rgb> direct;                ///< [patch_count * group_count], lx
  std::span<const std::uint32_t> glow_group;  ///< [patch_count]: the group of a patch's glow
};

/// What patches send of each group after so many sweeps, [patch_count * group_count], lm/m2: sums of groups are what as
/// many sweeps make of the sum. Throws `Cancelled`.
std::vector<Rgb> solve_groups(const GroupProblem& problem, std::uint32_t sweeps, RowCache& rows,
                              const Progress& progress);

}  // namespace radiosity
