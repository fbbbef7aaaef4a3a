#include "core/bake.h"

#include <algorithm>
#include <glm/common.hpp>

#include "core/mesh/patches.h"
#include "core/parallel.h"
#include "core/photometry.h"
#include "core/reconstruct/gather.h"
#include "core/transport/direct_light.h"
#include "core/transport/energy_balance.h"
#include "core/transport/exchange_checks.h"
#include "core/transport/row_keeper.h"
#include "core/transport/sky_light.h"
#include "core/transport/solve_gathering.h"
#include "core/transport/solve_progressive.h"
#include "core/visibility/item_buffer_raster.h"
#include "core/visibility/item_buffer_rays.h"

namespace radiosity {
namespace {

/// Where adaptive refinement ends is not known when patches are made. So many elements are expected of a simple scene,
/// and so many more for each that it starts with. With 4000 patches instead of 14 000 a dungeon was 60 % wrong at 1 %
/// of the points, instead of 37 %.
constexpr std::size_t kExpectedElements = 12'000, kExpectedPerElement = 3;

int patch_limit(const BakeOptions& options, const RefinedMesh& mesh) {
  if (options.max_patches > 0) return options.max_patches;
  std::size_t expected = mesh.elements.size();
  if (options.refine == Refine::kAdaptive) {
    expected = std::max(kExpectedElements + kExpectedPerElement * expected, 2 * options.adapt.max_vertices);
  }
  return automatic_patches(expected, options.hemicube_resolution);
}

bool use_raster(const Scene& scene, const BakeOptions& options) {
  if (options.visibility != Visibility::kAuto) return options.visibility == Visibility::kRaster;
  return raster_is_faster(scene.triangles.size(), options.hemicube_resolution);
}

/// What the patches send to the points where light is gathered, lm/m2.
std::vector<Rgb> sent_light(const Patches& patches, std::vector<Rgb> radiosity, LightParts parts) {
  for (std::uint32_t i = 0; i < patches.patch_count(); ++i) {
    radiosity[i] = sent_part(radiosity[i], patches.glow[i], parts);
  }
  return radiosity;
}

/// What patches send of each group, and room for what samples see of it; `direct` is the direct light of the groups.
SampleLog make_log(const Scene& scene, const Patches& patches, std::span<const Rgb> direct, std::uint32_t sweeps,
                   LightParts parts, RowCache& rows, const Progress& progress) {
  const std::vector<std::uint32_t> glow_group = glow_groups(scene, patches);
  SampleLog log;
  log.group_count = light_group_count(scene);
  log.radiosity = solve_groups({patches, log.group_count, direct, glow_group}, sweeps, rows, progress);
  for (std::uint32_t i = 0; i < patches.patch_count(); ++i) {
    for (std::uint32_t g = 0; g < log.group_count; ++g) {
      Rgb& radiosity = log.radiosity[std::size_t{i} * log.group_count + g];
      radiosity = sent_part(radiosity, g == glow_group[i] ? patches.glow[i] : Rgb(0.0F), parts);
    }
  }
  return log;
}

/// What samples have seen of each group -> its light at the vertices.
void finish_groups(const Scene& scene, const DisplayMesh& display, const SampleLog& log, const Reconstruction& light,
                   const BakeOptions& options, Bake& result) {
  if (options.fit == Fit::kInterpolate) {
    result.group_irradiance = light_of_groups(scene, display, log, light);
    return;
  }
  const GroupFits fits = fit_groups(display, log, light.samples);
  result.group_irradiance = light_of_groups(scene, fits, light.irradiance);
  if (!options.keep_transport) return;
  result.transport.emplace();
  result.transport->group_count = log.group_count;
  result.transport->parts = options.parts;
  keep_fits(fits.fit, fits.values, *result.transport);
}

BakeReport describe(const RefinedMesh& mesh, const Patches& patches, const Solution& solution,
                    const EnergyBalance& balance, const Samples& samples) {
  BakeReport report;
  report.patch_count = patches.patch_count();
  report.element_count = static_cast<std::uint32_t>(mesh.elements.size());
  report.vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
  report.steps = solution.steps;
  report.residual = solution.residual;
  report.emitted_flux = balance.emitted;
  report.absorbed_flux = balance.absorbed;
  report.escaped_flux = balance.escaped;
  report.buried_element_count = static_cast<std::uint32_t>(std::count(samples.buried.begin(), samples.buried.end(), 1));
  report.tile_count = patches.most_tiles;
  report.reached_tile_limit = patches.reached_tile_limit;
  report.degenerate_triangle_count = patches.degenerate_triangle_count;
  report.reflectance_clamped_area = patches.reflectance_clamped_area;
  report.lamp_count = static_cast<std::uint32_t>(patches.lamps.size());
  report.glow_share = patches.glow_share;
  report.lit = balance.emitted > 0.0 || !patches.lamps.empty();
  return report;
}

Bake bake_here(const Scene& scene, const BakeOptions& options, const Progress& progress) {
  // The display mesh, and the patches that light is exchanged between.
  Bake result;
  const RayScene rays(scene);
  DisplayMesh display = make_display_mesh(
      rays, {options.refine, options.subdivide, options.adapt.max_vertices, options.adapt.min_edge}, progress);
  const Patches patches = make_patches(rays, {patch_limit(options, display.mesh()), 2, options.max_tiles}, progress);

  // Visibility. A fit averages over many samples, so their hemicubes are half as wide.
  const bool raster = use_raster(scene, options);
  const auto items = raster ? make_item_buffer_raster(scene) : make_item_buffer_rays(rays);
  const Hemicube patch_hemicube(options.hemicube_resolution);
  const Hemicube sample_hemicube(std::max(2, options.hemicube_resolution / 4 * 2));
  const SmoothSky sky(scene.sky, sample_hemicube.resolution());
  const auto hemicube_rows = make_hemicube_rows(patches, patch_hemicube, *items, sky, surface_offset(scene));
  const RowInputs row_inputs{scene, patches, options.hemicube_resolution, raster};
  const auto kept_rows = options.row_keeper == nullptr ? nullptr : options.row_keeper->recall(row_inputs);
  RowCache rows(kept_rows ? *kept_rows : *hemicube_rows, options.row_cache_bytes);

  // Transport: direct light first, then the exchange between patches.
  const DirectLight direct_light(rays, patches, {options.lamp_rays, std::max(1, options.lamp_rays / 4)});
  std::vector<Rgb> group_direct(options.light_groups ? std::size_t{patches.patch_count()} * light_group_count(scene)
                                                     : 0);
  std::vector<Rgb> direct = direct_on_patches(direct_light, patches, progress, group_direct);
  add_sky(sky_on_patches(sky, rows, progress), scene, direct, group_direct);
  const auto gatherer_of = [&](std::span<const Rgb> sent, SampleLog* log) {
    return Gatherer{scene,
                    patches,
                    sample_hemicube,
                    *items,
                    direct_light,
                    sky,
                    sent,
                    surface_offset(scene),
                    options.parts != LightParts::kIndirect,
                    options.show_reached_side,
                    log};
  };
  constexpr double kSpare = 1.25;  // not every sample takes as long as those tried
  const std::vector<Rgb> dark(patches.patch_count(), Rgb(0.0F));
  const double gathering = kSpare * seconds_to_gather(display.mesh(), gatherer_of(dark, nullptr), {}, progress);
  const SolveProblem problem{patches, direct, options.residual, gathering};
  const Solution solution = options.solver == Solver::kGathering ? solve_gathering(problem, rows, progress)
                                                                 : solve_progressive(problem, rows, progress);
  if (options.row_keeper != nullptr && !kept_rows && rows.holds_all()) options.row_keeper->keep(row_inputs, rows);

  // Reconstruction: light at samples inside the elements, then at vertices; the mesh is cut where that misses the
  // light.
  const std::vector<Rgb> sent = sent_light(patches, solution.radiosity, options.parts);
  SampleLog log;
  if (options.light_groups) {
    const std::uint32_t sweeps = solution.steps / std::max(1U, patches.patch_count());
    log = make_log(scene, patches, group_direct, sweeps, options.parts, rows, progress);
    if (options.keep_transport) {
      log.cell_count = static_cast<std::uint32_t>(sample_hemicube.delta_form_factors().size());
      log.max_cell_bytes = options.row_cache_bytes / 2;
    }
  }
  const Gatherer gatherer = gatherer_of(sent, options.light_groups ? &log : nullptr);
  Reconstruction light = reconstruct(display, gatherer, options.fit, options.adapt, progress);
  if (options.light_groups) finish_groups(scene, display, log, light, options, result);
  if (result.transport && keep_exchange(scene, patches, rows, group_direct, *result.transport)) {
    keep_samples(display.mesh(), light.samples, log, sample_hemicube, *result.transport);
  }

  const EnergyBalance balance = energy_balance(problem, solution, rows);
  result.report = describe(display.mesh(), patches, solution, balance, light.samples);
  const ExchangeChecks checks = check_exchange(patches, rows);
  result.report.closure_error = checks.closure_error;
  result.report.reciprocity_error = checks.reciprocity_error;
  result.report.reached_element_limit = display.reached_limit;
  result.report.visibility = raster ? Visibility::kRaster : Visibility::kRays;
  result.report.estimated_error = light.estimated_error;
  result.report.refine_rounds = light.rounds;
  result.report.refine_end = light.end;
  result.report.out_of_time = solution.out_of_time || light.end == RefineEnd::kTime;

  result.irradiance = std::move(light.irradiance);
  result.mesh = finish(std::move(display), scene);
  return result;
}

}  // namespace

int automatic_patches(std::size_t element_count, int hemicube_resolution) {
  const double at_medium = std::clamp(static_cast<double>(element_count) / 3.0, 1000.0, 30'000.0);
  return std::max(1, static_cast<int>(at_medium * hemicube_resolution / 16.0));
}

Bake bake(const Scene& scene, const BakeOptions& options, const Progress& progress) {
  return on_threads(options.threads, [&] { return bake_here(scene, options, progress); });
}

}  // namespace radiosity
