// A picture of where a bake is wrong: what it shows, the truth, and the error, side by side.
#pragma once

#include "core/progress.h"
#include "core/visibility/ray_scene.h"
#include "plugin/image_decode.h"
#include "plugin/import_scene.h"
#include "plugin/verify.h"

namespace gltf_radiosity {

/// Both files, ready to be looked at. Not owned.
struct PicturedScenes {
  const ImportedScene& input;
  const radiosity::RayScene& input_rays;
  const ImportedScene& output;
  const radiosity::RayScene& output_rays;
};

/// The brightness of the picture.
struct PictureScale {
  double exposure = 1.0;  ///< m2/cd
  double mean = 0.0;      ///< luminance, cd/m2: errors are taken relative to (luminance + 0.1 mean)
};

/// Three panels, with a scale of the colours of the error below: from blue, kShownError too dark, over white to red,
/// kShownError too bright. Grey is what is not baked. The error is smoothed over the few pixels around that lie on a
/// surface of the same direction, against the noise of the truth. Parallel; throws `Cancelled`.
Pixels draw_error(const PicturedScenes& scenes, const PictureScale& scale, const VerifyOptions& options,
                  const radiosity::Progress& progress);

/// The relative error from which on colours are full.
inline constexpr double kShownError = 0.2;

}  // namespace gltf_radiosity
