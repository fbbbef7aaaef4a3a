#include "core/bake.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>

#include "core/mesh/patches.h"
#include "core/photometry.h"
#include "core/reconstruct/gather.h"
#include "core/reconstruct/interpolate_vertices.h"
#include "core/transport/direct_light.h"
#include "core/transport/solve_gathering.h"
#include "core/transport/solve_progressive.h"
#include "core/visibility/item_buffer_raster.h"
#include "core/visibility/item_buffer_rays.h"

namespace radiosity {
namespace {

Subdivision subdivide(const Scene& scene, const BakeOptions& options, const Progress& progress) {
  if (!options.refine_uniform) return {unrefined(scene), false};
  return subdivide_uniform(scene, options.subdivide, progress);
}

bool use_raster(const Scene& scene, const BakeOptions& options) {
  if (options.visibility != Visibility::kAuto) return options.visibility == Visibility::kRaster;
  return raster_is_faster(scene.triangles.size(), options.hemicube_resolution);
}

/// Adds what the open sky brings to each patch, by the share of its view that meets nothing.
void add_sky(const Rgb& sky, const Patches& patches, RowCache& rows, std::vector<Rgb>& direct,
             const Progress& progress) {
  if (!(luminance_of(sky) > 0.0F)) return;
  std::vector<std::uint32_t> order(patches.patch_count());
  std::iota(order.begin(), order.end(), 0U);
  constexpr std::size_t kRowsAtOnce = 256;
  for (std::size_t first = 0; first < order.size(); first += kRowsAtOnce) {
    progress.update("sky", static_cast<double>(first) / static_cast<double>(order.size()));
    const std::size_t count = std::min(kRowsAtOnce, order.size() - first);
    rows.fetch(std::span(order).subspan(first, count));
    for (std::size_t i = first; i < first + count; ++i) {
      direct[i] += irradiance_of_luminance(sky, rows.row(order[i]).to_sky);
    }
  }
}

/// Where the flux went: what patches send first, what they absorb, and what leaves through openings and onto backs.
void balance(const Patches& patches, const SolveProblem& problem, const Solution& solution, RowCache& rows,
             BakeReport& report) {
  for (std::uint32_t i = 0; i < patches.patch_count(); ++i) {
    const double area = patches.area[i];
    const Rgb exitance = exitance_of_luminance(patches.glow[i]);
    const Rgb irradiance = problem.direct[i] + solution.irradiance[i];
    report.emitted_flux += area * double{luminance_of(problem.direct[i] + exitance)};
    report.absorbed_flux += area * double{luminance_of((1.0F - patches.reflectance[i]) * irradiance)};
    if (!rows.holds(i)) continue;
    const FormFactorRow& row = rows.row(i);
    report.escaped_flux += area * double{(row.to_sky + row.to_backs) * luminance_of(solution.radiosity[i])};
  }
}

Bake bake_here(const Scene& scene, const BakeOptions& options, const Progress& progress) {
  // The display mesh, and the patches that light is exchanged between.
  Bake result;
  Subdivision subdivision = subdivide(scene, options, progress);
  result.mesh = std::move(subdivision.mesh);
  const Patches patches = make_patches(scene, {options.max_patches}, progress);

  // Visibility.
  const RayScene rays(scene);
  const bool raster = use_raster(scene, options);
  const auto items = raster ? make_item_buffer_raster(scene) : make_item_buffer_rays(rays);
  const Hemicube patch_hemicube(options.hemicube_resolution);
  const auto row_source = make_hemicube_rows(patches, patch_hemicube, *items, surface_offset(scene));
  RowCache rows(*row_source, options.row_cache_bytes);

  // Transport: direct light first, then the exchange between patches.
  const DirectLight direct_light(rays, patches, {});
  std::vector<Rgb> direct = direct_on_patches(direct_light, patches, progress);
  add_sky(scene.sky, patches, rows, direct, progress);
  const SolveProblem problem{patches, direct, options.residual};
  const Solution solution = options.solver == Solver::kGathering ? solve_gathering(problem, rows, progress)
                                                                 : solve_progressive(problem, rows, progress);

  // Reconstruction: light at elements, then at vertices. Elements average over their neighbours' hemicubes, so theirs
  // are half as wide.
  const Hemicube element_hemicube(std::max(2, options.hemicube_resolution / 4 * 2));
  const Gatherer gatherer{
      scene, patches, element_hemicube, *items, direct_light, solution.radiosity, surface_offset(scene)};
  const ElementLight light = gather_elements(result.mesh, gatherer, progress);
  result.irradiance = interpolate_vertices(result.mesh, light);

  // What was done.
  BakeReport& report = result.report;
  report.patch_count = patches.patch_count();
  report.element_count = static_cast<std::uint32_t>(result.mesh.elements.size());
  report.vertex_count = static_cast<std::uint32_t>(result.mesh.positions.size());
  report.steps = solution.steps;
  report.residual = solution.residual;
  report.buried_element_count = static_cast<std::uint32_t>(std::count(light.buried.begin(), light.buried.end(), 1));
  report.degenerate_triangle_count = patches.degenerate_triangle_count;
  report.reflectance_clamped_area = patches.reflectance_clamped_area;
  report.reached_element_limit = subdivision.reached_limit;
  report.visibility = raster ? Visibility::kRaster : Visibility::kRays;
  balance(patches, problem, solution, rows, report);
  report.lit = report.emitted_flux > 0.0 || !patches.lamps.empty();
  return result;
}

}  // namespace

Bake bake(const Scene& scene, const BakeOptions& options, const Progress& progress) {
  if (options.threads <= 0) return bake_here(scene, options, progress);
  const auto threads = static_cast<std::size_t>(options.threads);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  return bake_here(scene, options, progress);
}

}  // namespace radiosity
