// Proof of a bake: the baked file against path-traced truth in the scene it was baked from.
//
// A path tracer that shares no light transport with the baker computes the light at random places of the baked
// surfaces, in the scene of the source; the difference to what the baked file shows there is reported. The error of the
// mesh counts too: places lie anywhere on the triangles, not at vertices. Nothing here throws; nothing prints.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gltf_radiosity.h"  // by its short name: installed, the two lie side by side
#include "result.h"

namespace gltf_radiosity {

/// Where the picture of the error is taken from. Surfaces seen from behind are left out, as engines do.
struct VerifyCamera {
  std::optional<std::array<double, 3>> eye;  ///< metres; none: outside, on the diagonal of the scene's bounding box
  std::optional<std::array<double, 3>> at;   ///< metres, looked at; none: the middle of the bounding box
  double fov_degrees = 50.0;                 ///< vertical, (0, 180)
  int width = 480, height = 360;             ///< of each of the three panels, pixels, [16, 8192]
};

struct VerifyOptions {
  /// As for the bake: scene, sky, sun, default_sky, metals, light_units, and threads. The others have no effect.
  Options bake;
  int points = 2000;       ///< random places on the baked surfaces, [1, 1e7]
  double noise = 0.005;    ///< wanted of the truth: root mean variance over mean luminance, above 0
  int max_samples = 4096;  ///< paths per place that may be spent on it, [64, 2^20]
  std::uint64_t seed = 1;  ///< other places and other paths
  std::string image;       ///< a PNG that shows the baked file, the truth, and the error; empty for none
  int image_samples = 64;  ///< paths per pixel of the truth in it, [1, 2^20]
  VerifyCamera camera;
};

/// Errors are those of luminance at the fitted exposure.
struct VerifyReport {
  std::uint64_t points = 0;                ///< compared
  std::uint64_t unmatched_points = 0;      ///< left out: no surface of the source that faces the same way lies there
  std::uint64_t buried_points = 0;         ///< left out: inside something
  double exposure = 1.0;                   ///< k that fits best, m2/cd
  std::optional<double> written_exposure;  ///< the one that the baked file names
  std::optional<double> relative_rmse_written_exposure;  ///< the error when that one is taken
  double relative_rmse = 0.0;    ///< root mean square error over mean luminance, the truth's noise taken out
  double reference_noise = 0.0;  ///< of the truth: root mean variance over mean luminance
  double median = 0.0;           ///< of |error| / (luminance + 0.1 mean luminance)
  double p95 = 0.0, p99 = 0.0;   ///< 95 and 99 % of the points are better, likewise
  double mean_luminance = 0.0;   ///< of the truth, cd/m2
  double clipped_share = 0.0;    ///< of the points
  std::uint64_t paths = 0;
  std::uint64_t output_triangles = 0, output_vertices = 0;  ///< of the baked file, as often as nodes use them
  std::uint64_t t_vertices =
      0;  ///< cracks of the baked file: vertices inside a neighbour's edge (core/mesh/t_vertices.h)
  std::vector<PhaseReport> phases;  ///< "read", "import", "trace", "image"
  std::vector<Warning> warnings;
};

/// Compares the baked file `output` with its source `input`. Writes nothing but `wanted.image`, which appears whole or
/// not at all. ErrorCode::kBadInput if nothing in `output` is baked (COLOR_0 beside KHR_materials_unlit), or if none of
/// it lies on `input`.
Result<VerifyReport> verify_files(const std::string& input, const std::string& output, const VerifyOptions& wanted,
                                  const Callbacks& callbacks = {});

/// The report as JSON, indented by two spaces.
std::string to_json(const VerifyReport& report);

}  // namespace gltf_radiosity
