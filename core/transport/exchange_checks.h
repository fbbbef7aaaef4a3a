// How well the rows of F keep the identities that form factors have: a check on visibility, and figures for the report.
#pragma once

#include "core/transport/form_factors.h"

namespace radiosity {

/// Over the rows that are at hand.
struct ExchangeChecks {
  double closure_error = 0.0;      ///< largest |1 - sum of a row, sky and backs counted|
  double reciprocity_error = 0.0;  ///< sum of |A_i F_ij - A_j F_ji| over the sum of A_i F_ij, i and j both at hand.
                                   ///< Single pairs are noisy where patches are small: 0.9 is usual, and the noise of
                                   ///< a row averages out; see EnergyBalance
};

/// Rows that are no longer cached are left out.
ExchangeChecks check_exchange(const Patches& patches, const RowCache& rows);

}  // namespace radiosity
