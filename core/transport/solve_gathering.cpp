#include "core/transport/solve_gathering.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/photometry.h"

namespace radiosity {
namespace {

constexpr std::size_t kRowsAtOnce = 256;

/// Reflectance is at most 0.98: 500 sweeps bring any residual below 1e-4 even in a closed room.
constexpr std::uint32_t kMaxSweeps = 1000;

}  // namespace

Solution solve_gathering(const SolveProblem& problem, RowCache& rows, const Progress& progress) {
  const Patches& patches = problem.patches;
  const std::uint32_t count = patches.patch_count();
  const std::vector<glm::dvec3> first = first_radiosity(problem);
  std::vector<glm::dvec3> radiosity = first, irradiance(count, glm::dvec3(0.0));
  const double emitted = flux_of(patches, first);
  // A sweep that changes little has still 1 / (1 - rho) as much to come.
  const glm::dvec3 absorbed = 1.0 - mean_reflectance(patches);
  const double wanted = double{problem.residual} * std::min({absorbed.x, absorbed.y, absorbed.z});
  Solution solution;
  solution.converged = !(emitted > 0.0);

  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  Pace pace(progress, problem.reserved_seconds);
  for (std::uint32_t sweep = 0; sweep < kMaxSweeps && !solution.converged && !solution.out_of_time; ++sweep) {
    double change = 0.0;
    for (std::uint32_t i = 0; i < count; ++i) {
      // Rows in batches, side by side; after the first sweep they are at hand unless memory was short.
      if (i % kRowsAtOnce == 0) {
        progress.update("solve", sweep == 0 ? 0.9 * i / count : 0.9);
        solution.out_of_time = !pace.allows_another_step();
        if (solution.out_of_time) break;
        rows.fetch(std::span(order).subspan(i, std::min<std::size_t>(kRowsAtOnce, count - i)));
      }
      const FormFactorRow& row = rows.row(i);
      glm::dvec3 gathered(0.0);
      for (std::size_t k = 0; k < row.patch.size(); ++k) gathered += double{row.factor[k]} * radiosity[row.patch[k]];
      const glm::dvec3 updated = first[i] + glm::dvec3(patches.reflectance[i]) * gathered;
      change += double{patches.area[i]} * std::abs(double{luminance_of(Rgb(updated - radiosity[i]))});
      radiosity[i] = updated;
      irradiance[i] = gathered;
    }
    if (solution.out_of_time) break;
    solution.steps += count;
    solution.residual = static_cast<float>(change / emitted);
    solution.converged = double{solution.residual} <= wanted;
  }

  solution.radiosity.assign(radiosity.begin(), radiosity.end());
  solution.irradiance.assign(irradiance.begin(), irradiance.end());
  progress.update("solve", 1.0);
  return solution;
}

std::vector<Rgb> solve_groups(const GroupProblem& problem, std::uint32_t sweeps, RowCache& rows,
                              const Progress& progress) {
  const Patches& patches = problem.patches;
  const std::uint32_t count = patches.patch_count();
  const std::size_t groups = problem.group_count;
  const auto own = [groups](auto& values, std::uint32_t patch) {
    return std::span(values).subspan(patch * groups, groups);
  };

  // What each patch sends before light is exchanged.
  std::vector<glm::dvec3> first(count * groups);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::span<glm::dvec3> here = own(first, i);
    for (std::size_t g = 0; g < groups; ++g) {
      here[g] = glm::dvec3(patches.reflectance[i]) * glm::dvec3(problem.direct[i * groups + g]);
    }
    here[problem.glow_group[i]] += glm::dvec3(exitance_of_luminance(patches.glow[i]));
  }

  std::vector<glm::dvec3> radiosity = first, gathered(groups);
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  for (std::uint32_t sweep = 0; sweep < sweeps; ++sweep) {
    for (std::uint32_t i = 0; i < count; ++i) {
      if (i % kRowsAtOnce == 0) {
        progress.update("solve", 0.9 + 0.1 * sweep / sweeps);
        rows.fetch(std::span(order).subspan(i, std::min<std::size_t>(kRowsAtOnce, count - i)));
      }
      const FormFactorRow& row = rows.row(i);
      std::fill(gathered.begin(), gathered.end(), glm::dvec3(0.0));
      for (std::size_t k = 0; k < row.patch.size(); ++k) {
        const std::span<const glm::dvec3> sent = own(radiosity, row.patch[k]);
        for (std::size_t g = 0; g < groups; ++g) gathered[g] += double{row.factor[k]} * sent[g];
      }
      const std::span<glm::dvec3> here = own(radiosity, i), start = own(first, i);
      for (std::size_t g = 0; g < groups; ++g) here[g] = start[g] + glm::dvec3(patches.reflectance[i]) * gathered[g];
    }
  }
  return {radiosity.begin(), radiosity.end()};
}

}  // namespace radiosity
