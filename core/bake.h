// START HERE: Scene -> light at every vertex, the whole method in one short function.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/light_groups.h"
#include "core/light_transport.h"
#include "core/mesh/display_mesh.h"
#include "core/mesh/patches.h"
#include "core/mesh/refined_mesh.h"
#include "core/mesh/subdivide_uniform.h"
#include "core/progress.h"
#include "core/reconstruct/reconstruct.h"
#include "core/scene.h"

namespace radiosity {

/// Which maker fills the item buffers.
enum class Visibility : std::uint8_t { kAuto, kRaster, kRays };

/// Which method solves for the light between the patches.
enum class Solver : std::uint8_t { kProgressive, kGathering };

class RowKeeper;

struct BakeOptions {
  Refine refine = Refine::kUniform;
  SubdivideOptions subdivide;    ///< how the display mesh is cut, or what adaptive refinement starts from
  RefineOptions adapt;           ///< for Refine::kAdaptive
  int hemicube_resolution = 16;  ///< cells along one edge of a hemicube, even, >= 2
  Visibility visibility = Visibility::kAuto;
  Solver solver = Solver::kGathering;
  Fit fit = Fit::kLeastSquares;
  bool light_groups = false;             ///< the light of each group too; needs Solver::kGathering
  bool keep_transport = false;           ///< and what other lights and reflectances take; needs Fit::kLeastSquares too
  bool show_reached_side = false;        ///< of surfaces that are lit on both sides and whose front no light reaches
  LightParts parts = LightParts::kBoth;  ///< of the result; the parts add up to both, but for the noise of each fit
  float residual = 0.001F;               ///< stop when this share of the emitted flux is still unshot, (0,1)
  int max_patches = 0;  ///< patches that send light; more see finer indirect light; 0: see automatic_patches()
  std::size_t max_tiles = PatchOptions{}.max_tiles;
  int lamp_rays = 32;  ///< shadow rays from a sample to all lamps together, where some are hidden
  std::size_t row_cache_bytes = std::size_t{1} << 30;  ///< memory for rows of form factors: older ones are evicted
  int threads = 0;                                     ///< 0 uses every core; the result does not depend on it
  RowKeeper* row_keeper = nullptr;                     ///< not owned; rows of an earlier bake; null: there are none
};

/// As many patches as a display mesh of `element_count` elements is worth: a third of them, but at least a thousand and
/// at most thirty thousand, more with wide hemicubes and fewer with narrow ones. A Cornell box of 10 000 elements is
/// 1.9 % wrong with 1 000 patches, 1.8 % with 3 000, and 1.7 % with 10 000 at 3.4 times the time; a map of a hundred
/// rooms 11.8 % with 10 000, 8.6 % with 20 000, 7.3 % with 30 000.
int automatic_patches(std::size_t element_count, int hemicube_resolution);

/// What was done, for reports. Fluxes are in lumen, all bands weighted to luminance.
struct BakeReport {
  std::uint32_t patch_count = 0;
  std::uint32_t tile_count = 0;  ///< at most while patches were made
  std::uint32_t element_count = 0;
  std::uint32_t vertex_count = 0;
  std::uint32_t steps = 0;                 ///< shots, or sweeps times patches when gathering
  float residual = 0.0F;                   ///< share of the emitted flux left unshot
  double emitted_flux = 0.0;               ///< what lamps, lights and sky bring onto or off the surfaces, lm
  double absorbed_flux = 0.0;              ///< lm
  double escaped_flux = 0.0;               ///< lm that left through openings
  std::uint32_t buried_element_count = 0;  ///< elements that see mostly back faces: their light is their neighbours'
  std::uint32_t degenerate_triangle_count = 0;  ///< triangles without area: kept, but they carry no light
  double closure_error = 0.0;                   ///< see exchange_checks.h
  double reciprocity_error = 0.0;               ///< likewise
  std::uint32_t lamp_count = 0;                 ///< parts of emissive triangles that shadow rays go to
  double glow_share = 0.0;                      ///< of the emitted flux: what is left to hemicubes, [0,1]
  double reflectance_clamped_area = 0.0;        ///< m2 whose reflectance was above kMaxReflectance
  bool reached_element_limit = false;
  bool reached_tile_limit = false;  ///< BakeOptions::max_tiles made patches coarser
  bool out_of_time = false;         ///< the time was over before the light was solved or the mesh fine enough
  double estimated_error = 0.0;     ///< of the light that is displayed, relative RMSE
  std::uint32_t refine_rounds = 0;
  RefineEnd refine_end = RefineEnd::kNotAdaptive;
  Visibility visibility = Visibility::kRays;  ///< what kAuto chose
  bool lit = false;                           ///< whether the scene holds any light at all
};

struct Bake {
  RefinedMesh mesh;
  std::vector<Rgb> irradiance;  ///< H at each vertex of `mesh`, [vertex_count], lx, never negative
  /// If asked for: H of each light group before it is dimmed, [light_group_count()][vertex_count], lx, never negative.
  /// Each times its dimmer, they add up to `irradiance`.
  std::vector<std::vector<Rgb>> group_irradiance;
  /// If asked for. Without rows where they, or what samples see, would have taken more than half of
  /// BakeOptions::row_cache_bytes.
  std::optional<KeptTransport> transport;
  BakeReport report;
};

/// Computes the light of a valid scene (validate()). Same scene and options give the same bytes for any number of
/// threads, unless the time is limited. Throws `Cancelled` when `progress` says so, `OutOfTime` when the time is not
/// enough for any light, and std::bad_alloc when memory runs out.
Bake bake(const Scene& scene, const BakeOptions& options, const Progress& progress);

}  // namespace radiosity
