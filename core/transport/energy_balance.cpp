#include "core/transport/energy_balance.h"

#include "core/photometry.h"

namespace radiosity {

EnergyBalance energy_balance(const SolveProblem& problem, const Solution& solution, RowCache& rows) {
  const Patches& patches = problem.patches;
  EnergyBalance balance;
  for (std::uint32_t i = 0; i < patches.patch_count(); ++i) {
    const double area = patches.area[i];
    const Rgb exitance = exitance_of_luminance(patches.glow[i]);
    const Rgb irradiance = problem.direct[i] + solution.irradiance[i];
    balance.emitted += area * double{luminance_of(problem.direct[i] + exitance)};
    balance.absorbed += area * double{luminance_of((1.0F - patches.reflectance[i]) * irradiance)};
    if (!rows.holds(i)) continue;
    const FormFactorRow& row = rows.row(i);
    balance.escaped += area * double{(row.to_sky + row.to_backs) * luminance_of(solution.radiosity[i])};
  }
  return balance;
}

}  // namespace radiosity
