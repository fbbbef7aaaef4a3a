#include "core/transport/exchange_checks.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace radiosity {
namespace {

/// Patches are numbered from place to place: so many runs of them are compared with one another.
constexpr std::size_t kRegions = 64;

}  // namespace

ExchangeChecks check_exchange(const Patches& patches, const RowCache& rows) {
  // Closure of each row, and the exchange A_i F_ij summed from region to region.
  ExchangeChecks checks;
  const std::size_t count = patches.patch_count();
  std::vector<double> exchanged(kRegions * kRegions, 0.0);
  const auto region = [count](std::size_t patch) { return patch * kRegions / count; };
  bool all_at_hand = true;
  for (std::uint32_t i = 0; i < count; ++i) {
    const FormFactorRow* const row = rows.peek(i);
    if (row == nullptr) {
      all_at_hand = false;
      continue;
    }
    const double sum =
        std::accumulate(row->factor.begin(), row->factor.end(), double{row->to_sky} + double{row->to_backs});
    checks.closure_error = std::max(checks.closure_error, std::abs(1.0 - sum));
    // What is out of the light's reach is one patch wherever it lies, and exchanges none.
    if (i == patches.unreached) continue;
    for (std::size_t k = 0; k < row->patch.size(); ++k) {
      if (row->patch[k] == patches.unreached) continue;
      exchanged[region(i) * kRegions + region(row->patch[k])] += double{patches.area[i]} * double{row->factor[k]};
    }
  }
  if (!all_at_hand) return checks;

  // There and back.
  double difference = 0.0, total = 0.0;
  for (std::size_t a = 0; a < kRegions; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const double there = exchanged[a * kRegions + b], back = exchanged[b * kRegions + a];
      difference += std::abs(there - back);
      total += 0.5 * (there + back);
    }
  }
  checks.reciprocity_error = total > 0.0 ? difference / total : 0.0;
  return checks;
}

}  // namespace radiosity
