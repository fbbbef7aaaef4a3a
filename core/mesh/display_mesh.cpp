#include "core/mesh/display_mesh.h"

#include <algorithm>
#include <utility>

#include "core/mesh/stitch.h"

namespace radiosity {
namespace {

BisectLimits limits_of(const Scene& scene, const DisplayMeshOptions& options) {
  const std::size_t max_vertices = options.max_vertices;
  const float min_edge = options.min_edge;
  return {.max_vertices = max_vertices > 0 ? max_vertices : automatic_max_vertices(scene),
          .max_elements = options.subdivide.max_elements,
          .min_edge = min_edge > 0.0F ? min_edge : default_patch_size(scene) / 16.0F,
          .level_of_triangle = options.subdivide.level_of_triangle};
}

}  // namespace

DisplayMesh make_display_mesh(const Scene& scene, const DisplayMeshOptions& options, const Progress& progress) {
  DisplayMesh display;
  if (options.refine == Refine::kNone) {
    display.uncut = unrefined(scene);
  } else if (options.refine == Refine::kUniform) {
    Subdivision subdivision = subdivide_uniform(scene, options.subdivide, progress);
    display.uncut = std::move(subdivision.mesh);
    display.reached_limit = subdivision.reached_limit;
  } else {
    SubdivideOptions levels = options.subdivide;
    levels.patch_size = 0.0F;
    const BisectLimits limits = limits_of(scene, options);
    display.cut = std::make_unique<CutMesh>(scene);
    stitch(*display.cut, limits.max_vertices - std::min(limits.max_vertices, scene.positions.size()));
    display.reached_limit = subdivide_uniform(*display.cut, levels, progress);
    display.bisector = std::make_unique<Bisector>(*display.cut, limits);
    if (options.subdivide.patch_size > 0.0F) display.bisector->bisect_longer_than(double{options.subdivide.patch_size});
  }
  return display;
}

RefinedMesh finish(DisplayMesh display, const Scene& scene) {
  if (!display.cut) return std::move(display.uncut);
  group_by_triangle(display.cut->mesh, scene.triangles.size());
  return std::move(display.cut->mesh);
}

std::size_t automatic_max_vertices(const Scene& scene) { return scene.positions.size() + 16'000; }

}  // namespace radiosity
