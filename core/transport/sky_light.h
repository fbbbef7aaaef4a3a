// Light of the open sky on the patches, by the share of each one's view that meets nothing.
#pragma once

#include <vector>

#include "core/progress.h"
#include "core/transport/form_factors.h"

namespace radiosity {

/// Adds the irradiance (lx) from a sky of luminance `sky` (cd/m2) to `direct`, [patch_count]. Needs every row of F
/// unless the sky is black. Throws `Cancelled`.
void add_sky(const Rgb& sky, RowCache& rows, std::vector<Rgb>& direct, const Progress& progress);

}  // namespace radiosity
