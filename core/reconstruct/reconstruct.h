// Light at samples inside the elements, then at the vertices; where that misses the light, the mesh is cut and sampled
// again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/mesh/display_mesh.h"
#include "core/progress.h"
#include "core/reconstruct/fit_vertices.h"
#include "core/reconstruct/gather.h"
#include "core/reconstruct/refine.h"
#include "core/reconstruct/samples.h"

namespace radiosity {

/// How samples become light at vertices.
enum class Fit : std::uint8_t { kLeastSquares, kInterpolate };

/// Where the display mesh is cut when the light decides.
struct RefineOptions {
  double max_error = 0.02;       ///< enough when the estimate of the relative RMSE is not above this, > 0
  std::size_t max_vertices = 0;  ///< no more than this, those of the scene included; 0: see automatic_max_vertices()
  ErrorSpace space = ErrorSpace::kDisplay;  ///< what decides which elements are cut first
  float exposure = 0.0F;                    ///< k, m2/cd, at which what is brighter than white is clipped; 0: automatic
  float min_edge = 0.0F;  ///< elements no longer than this are not cut, metres; 0: a sixteenth of default_patch_size()
};

/// Why refinement came to its end.
enum class RefineEnd : std::uint8_t { kNotAdaptive, kError, kLimit, kFloor, kTime };

/// Light at the vertices of the display mesh, and what it took.
struct Reconstruction {
  Samples samples;
  std::vector<Rgb> irradiance;
  double estimated_error = 0.0;
  std::uint32_t rounds = 0;
  RefineEnd end = RefineEnd::kNotAdaptive;
};

/// How the samples of a display mesh are fitted to its vertices.
FitOptions fit_options(const DisplayMesh& display);

/// Cuts an adaptive `display` until the estimate of its error is small enough, or a limit or the end of the time is
/// reached. Nothing is gathered twice. Parallel; deterministic but for the time; throws `Cancelled`.
Reconstruction reconstruct(DisplayMesh& display, const Gatherer& gatherer, Fit how, const RefineOptions& adapt,
                           const Progress& progress);

}  // namespace radiosity
