#include "core/mesh/display_mesh.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/mesh/contacts.h"
#include "core/mesh/cut_contacts.h"
#include "core/mesh/stitch.h"

namespace radiosity {
namespace {

BisectLimits limits_of(const Scene& scene, const DisplayMeshOptions& options) {
  const std::size_t max_vertices = options.max_vertices;
  const float min_edge = options.min_edge;
  return {.mesh = {.max_vertices = max_vertices > 0 ? max_vertices : automatic_max_vertices(scene),
                   .max_elements = options.subdivide.max_elements},
          .min_edge = min_edge > 0.0F ? min_edge : default_patch_size(scene) / 16.0F,
          .level_of_triangle = options.subdivide.level_of_triangle};
}

/// The whole: cut to one size, then along contacts.
void make_uniform(DisplayMesh& display, const RayScene& rays, const SubdivideOptions& options,
                  const Progress& progress) {
  const Scene& scene = rays.scene();
  CutMesh cut(scene);
  stitch(cut, options.max_elements - std::min(options.max_elements, scene.triangles.size()));
  display.reached_limit = subdivide_uniform(cut, options, progress);
  const std::vector<Contact> contacts =
      options.patch_size > 0.0F ? find_contacts(rays, {options.patch_size, options.level_of_triangle}, progress)
                                : std::vector<Contact>{};
  if (!contacts.empty()) {
    EdgeCopies edges(cut);
    ContactCutter(cut, edges, scene, contacts).cut_all({.max_elements = options.max_elements});
  }
  display.uncut = std::move(cut.mesh);
  group_by_triangle(display.uncut, scene.triangles.size());
}

/// What refinement starts from.
void make_coarse(DisplayMesh& display, const RayScene& rays, const DisplayMeshOptions& options,
                 const Progress& progress) {
  const Scene& scene = rays.scene();
  SubdivideOptions levels = options.subdivide;
  levels.patch_size = 0.0F;
  const BisectLimits limits = limits_of(scene, options);
  display.cut = std::make_unique<CutMesh>(scene);
  stitch(*display.cut, limits.mesh.max_vertices - std::min(limits.mesh.max_vertices, scene.positions.size()));
  display.reached_limit = subdivide_uniform(*display.cut, levels, progress);
  display.edges = std::make_unique<EdgeCopies>(*display.cut);
  const std::vector<Contact> contacts =
      find_contacts(rays, {default_patch_size(scene), options.subdivide.level_of_triangle}, progress);
  if (!contacts.empty()) {
    display.contacts = std::make_unique<ContactCutter>(*display.cut, *display.edges, scene, contacts);
  }
  display.bisector = std::make_unique<Bisector>(*display.cut, *display.edges, limits, display.contacts.get());
  if (options.subdivide.patch_size > 0.0F) display.bisector->bisect_longer_than(double{options.subdivide.patch_size});
}

}  // namespace

DisplayMesh make_display_mesh(const RayScene& rays, const DisplayMeshOptions& options, const Progress& progress) {
  DisplayMesh display;
  if (options.refine == Refine::kNone) {
    display.uncut = unrefined(rays.scene());
  } else if (options.refine == Refine::kUniform) {
    make_uniform(display, rays, options.subdivide, progress);
  } else {
    make_coarse(display, rays, options, progress);
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
