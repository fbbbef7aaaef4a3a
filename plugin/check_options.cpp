#include "plugin/check_options.h"

#include <algorithm>
#include <cmath>

namespace gltf_radiosity {
namespace {

bool is_finite_and_at_least(double value, double least) { return std::isfinite(value) && value >= least; }

bool is_valid(const Sun& sun) {
  return std::isfinite(sun.azimuth_degrees) && std::abs(sun.elevation_degrees) <= 90.0 &&
         is_finite_and_at_least(sun.illuminance_lux, 0.0);
}

}  // namespace

Result<Done> check_options(const Options& options) {
  const auto refuse = [](const char* option, const char* why) { return Error{ErrorCode::kBadOption, option, why}; };

  // Mesh.
  if (!is_finite_and_at_least(options.patch_size, 0.0)) return refuse("--patch-size", "must not be negative");
  for (const auto& [name, level] : options.subdivide) {
    if (level < 0 || level > 8) return refuse("--subdivide", "the level must be between 0 and 8");
  }

  // Light.
  if (options.sky && !std::all_of(options.sky->begin(), options.sky->end(),
                                  [](double band) { return is_finite_and_at_least(band, 0.0); })) {
    return refuse("--sky", "must not be negative");
  }
  if (options.sky && !options.sky_file.empty()) return refuse("--sky", "is either a luminance or a file");
  if (!std::isfinite(options.sky_rotation_degrees)) return refuse("--sky-rotation", "must be finite");
  if (options.sun && !is_valid(*options.sun)) {
    return refuse("--sun", "needs an elevation between -90 and 90 degrees and an illuminance that is not negative");
  }

  // Transport.
  if (options.hemicube < 2 || options.hemicube > 512 || options.hemicube % 2 != 0) {
    return refuse("--hemicube", "must be even and between 2 and 512");
  }
  if (!(options.residual > 0.0 && options.residual < 1.0)) return refuse("--residual", "must lie between 0 and 1");
  if (options.max_patches < 1) return refuse("--max-patches", "must be at least 1");
  if (options.threads < 0) return refuse("--threads", "must not be negative");

  // Output.
  if (options.exposure && !(is_finite_and_at_least(*options.exposure, 0.0) && *options.exposure > 0.0)) {
    return refuse("--exposure", "must be above 0");
  }
  return Done{};
}

}  // namespace gltf_radiosity
