// The display mesh: the scene's own triangles, cut to one size, or as far as the light needs it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "core/mesh/cut_mesh.h"
#include "core/mesh/refined_mesh.h"
#include "core/mesh/subdivide_adaptive.h"
#include "core/mesh/subdivide_uniform.h"
#include "core/progress.h"
#include "core/scene.h"
#include "core/visibility/ray_scene.h"

namespace radiosity {

/// What the display mesh is: the scene's own triangles, cut to one size, or cut where the light needs it.
enum class Refine : std::uint8_t { kNone, kUniform, kAdaptive };

struct DisplayMeshOptions {
  Refine refine = Refine::kUniform;
  SubdivideOptions subdivide;    ///< how it is cut, or what adaptive refinement starts from
  std::size_t max_vertices = 0;  ///< for kAdaptive, those of the scene included; 0: see automatic_max_vertices()
  float min_edge = 0.0F;         ///< likewise: shorter elements are not cut, metres; 0: 1/16 of default_patch_size()
};

/// Finished, or with what it takes to cut it further.
struct DisplayMesh {
  RefinedMesh uncut;                        ///< unless adaptive
  std::unique_ptr<CutMesh> cut;             ///< if adaptive
  std::unique_ptr<EdgeCopies> edges;        ///< likewise, of `cut`
  std::unique_ptr<ContactCutter> contacts;  ///< likewise: cuts it along contacts
  std::unique_ptr<Bisector> bisector;       ///< likewise: cuts it
  bool reached_limit = false;               ///< `max_elements` ended the subdivision

  const RefinedMesh& mesh() const { return cut ? cut->mesh : uncut; }
};

/// The mesh that refinement starts from, or the whole. Unless it stays unrefined, T-vertices of the scene are gone and
/// it is cut along contacts.
/// Deterministic. Throws `Cancelled`.
DisplayMesh make_display_mesh(const RayScene& rays, const DisplayMeshOptions& options, const Progress& progress);

/// The mesh, its elements grouped by triangle.
RefinedMesh finish(DisplayMesh display, const Scene& scene);

/// What adaptive refinement may use unless told: the scene's own vertices and 16 000 more.
std::size_t automatic_max_vertices(const Scene& scene);

}  // namespace radiosity
