// Light of the open sky by what hemicubes see of it. What is too bright and small for them comes with the direct light.
#pragma once

#include <vector>

#include "core/progress.h"
#include "core/transport/form_factors.h"

namespace radiosity {

/// Sum of the delta form factors of the cells that meet nothing, times what the sky shows there, cd/m2.
Rgb luminance_of_sky(const SmoothSky& sky, const Hemicube& hemicube, const Viewpoint& viewpoint,
                     const ItemBuffer& items);

/// Irradiance (lx) that `sky` brings to the patches, [patch_count]; empty if the sky is black, else it needs every row
/// of F. Throws `Cancelled`.
std::vector<Rgb> sky_on_patches(const SmoothSky& sky, RowCache& rows, const Progress& progress);

}  // namespace radiosity
