#include "plugin/check_options.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

namespace gltf_radiosity {
namespace {

constexpr int kMaxPaths = 1 << 20;

bool is_finite_and_at_least(double value, double least) { return std::isfinite(value) && value >= least; }

bool is_valid(const Sun& sun) {
  return std::isfinite(sun.azimuth_degrees) && std::abs(sun.elevation_degrees) <= 90.0 &&
         is_finite_and_at_least(sun.illuminance_lux, 0.0);
}

bool is_attribute_name(const std::string& name) {
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
  return name.size() <= 64 && name.find_first_not_of(kAllowed) == std::string::npos;
}

Error refuse(const char* option, const char* why) { return {ErrorCode::kBadOption, option, why}; }

Result<Done> check_light_groups(const Options& options) {
  for (const auto& [name, pattern] : options.groups) {
    if (name.empty() || pattern.empty()) return refuse("--group", "neither the name nor the pattern may be empty");
  }
  if (options.light_groups == LightGroupStorage::kNone) {
    return options.groups.empty() ? Result<Done>(Done{}) : refuse("--group", "needs --light-groups");
  }
  if (options.solver != SolverMethod::kGathering) return refuse("--light-groups", "needs --solver gathering");
  if (!options.save_transport.empty()) return refuse("--light-groups", "excludes --save-transport");
  if (options.simplify) return refuse("--light-groups", "excludes --simplify, which looks at the whole light only");
  return Done{};
}

}  // namespace

Result<Done> check_options(const Options& options) {
  // Mesh.
  if (!is_finite_and_at_least(options.patch_size, 0.0)) return refuse("--patch-size", "must not be negative");
  if (!(std::isfinite(options.max_error) && options.max_error > 0.0)) return refuse("--max-error", "must be above 0");
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
  if (!options.save_transport.empty() && options.solver != SolverMethod::kGathering) {
    return refuse("--save-transport", "needs --solver gathering: the light of each source must add up");
  }
  if (!options.save_transport.empty() && options.fit != FitMethod::kLeastSquares) {
    return refuse("--save-transport", "needs --fit least-squares");
  }
  if (options.max_patches < 0) return refuse("--max-patches", "must not be negative");
  if (options.max_memory != 0 && options.max_memory < (std::uint64_t{64} << 20U)) {
    return refuse("--max-memory", "must be at least 64M");
  }
  if (options.threads < 0) return refuse("--threads", "must not be negative");
  if (!is_finite_and_at_least(options.time_limit, 0.0)) return refuse("--time-limit", "must not be negative");

  // Output.
  if (options.exposure && !(is_finite_and_at_least(*options.exposure, 0.0) && *options.exposure > 0.0)) {
    return refuse("--exposure", "must be above 0");
  }
  if (!is_attribute_name(options.radiance_attribute)) {
    return refuse("--radiance-attribute", "must be up to 64 letters, digits and underscores");
  }
  if (options.draco_bits != 0 && (options.draco_bits < 8 || options.draco_bits > 24)) {
    return refuse("--draco", "must lie between 8 and 24");
  }
  if (options.draco_bits != 0 && options.meshopt) return refuse("--meshopt", "excludes --draco");
  if (const auto checked = check_light_groups(options); !checked) return checked.error();
  return Done{};
}

Result<Done> check_options(const VerifyOptions& options) {
  if (const auto checked = check_options(options.bake); !checked) return checked.error();

  // Sampling.
  if (options.points < 1 || options.points > 10'000'000) return refuse("--points", "must lie between 1 and 1e7");
  if (!(is_finite_and_at_least(options.noise, 0.0) && options.noise > 0.0)) return refuse("--noise", "must be above 0");
  if (options.max_samples < 64 || options.max_samples > kMaxPaths) {
    return refuse("--max-samples", "must lie between 64 and 1048576");
  }

  // Picture.
  const VerifyCamera& camera = options.camera;
  if (options.image_samples < 1 || options.image_samples > kMaxPaths) {
    return refuse("--image-samples", "must lie between 1 and 1048576");
  }
  for (const auto& [option, place] : {std::pair("--eye", &camera.eye), std::pair("--at", &camera.at)}) {
    if (*place && !std::ranges::all_of(**place, [](double x) { return std::isfinite(x) && std::abs(x) < 1e30; })) {
      return refuse(option, "must be finite");
    }
  }
  if (!(camera.fov_degrees > 0.0 && camera.fov_degrees < 180.0)) return refuse("--fov", "must lie between 0 and 180");
  if (std::min(camera.width, camera.height) < 16 || std::max(camera.width, camera.height) > 8192) {
    return refuse("--size", "must lie between 16 and 8192");
  }
  return Done{};
}

}  // namespace gltf_radiosity
