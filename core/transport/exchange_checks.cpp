#include "core/transport/exchange_checks.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace radiosity {
namespace {

/// F_ij of a row; 0 where it has none.
double factor_to(const FormFactorRow& row, std::uint32_t j) {
  const auto found = std::lower_bound(row.patch.begin(), row.patch.end(), j);
  if (found == row.patch.end() || *found != j) return 0.0;
  return double{row.factor[static_cast<std::size_t>(found - row.patch.begin())]};
}

}  // namespace

ExchangeChecks check_exchange(const Patches& patches, const RowCache& rows) {
  std::vector<const FormFactorRow*> row_of(patches.patch_count());
  for (std::uint32_t i = 0; i < row_of.size(); ++i) row_of[i] = rows.peek(i);

  ExchangeChecks checks;
  double difference = 0.0, exchanged = 0.0;
  for (std::uint32_t i = 0; i < row_of.size(); ++i) {
    if (row_of[i] == nullptr) continue;
    const FormFactorRow& row = *row_of[i];
    const double sum = std::accumulate(row.factor.begin(), row.factor.end(), double{row.to_sky} + double{row.to_backs});
    checks.closure_error = std::max(checks.closure_error, std::abs(1.0 - sum));
    for (std::size_t k = 0; k < row.patch.size(); ++k) {
      // Every pair from the side of the smaller number, or from the only side that sees the other.
      const std::uint32_t j = row.patch[k];
      if (j == i || row_of[j] == nullptr) continue;
      const double back = factor_to(*row_of[j], i);
      if (j < i && back > 0.0) continue;
      const double there = double{patches.area[i]} * double{row.factor[k]}, here = double{patches.area[j]} * back;
      difference += std::abs(there - here);
      exchanged += 0.5 * (there + here);
    }
  }
  checks.reciprocity_error = exchanged > 0.0 ? difference / exchanged : 0.0;
  return checks;
}

}  // namespace radiosity
