// How well the rows of F keep the identities that form factors have: a check on visibility, and figures for the report.
#pragma once

#include "core/transport/form_factors.h"

namespace radiosity {

struct ExchangeChecks {
  double closure_error = 0.0;  ///< largest |1 - sum of a row, sky and backs counted|, over the rows at hand
  /// Sum of |A_i F_ij - A_j F_ji| over the sum of A_i F_ij, where i and j are 64 regions of the scene: single patches
  /// differ by noise that a row averages out. 0 where rows have been evicted.
  double reciprocity_error = 0.0;
};

ExchangeChecks check_exchange(const Patches& patches, const RowCache& rows);

}  // namespace radiosity
