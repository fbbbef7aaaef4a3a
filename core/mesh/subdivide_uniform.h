// Cuts every triangle until no edge is longer than the patch size, or a given number of times.
//
// Works in rounds. In each, a triangle asks for edges to be halved: all three while it has levels left, otherwise those
// longer than the patch size. An edge is halved if any triangle at it asks, on every copy of it that shares its two end
// positions: across seams, primitives and nodes. Then a triangle with three halved edges becomes four, with two three,
// with one two:
//
//        /\            /\            /\                                                                               .
//       /__\          /__\          /| \                                                                              .
//      /\  /\        / \  \        / |  \                                                                             .
//     /__\/__\      /___\__\      /__|___\                                                                            .
//
// No vertex ever lies inside a neighbour's edge, so there are no T-vertices that the scene did not have.
#pragma once

#include <cstdint>
#include <span>

#include "core/mesh/cut_mesh.h"
#include "core/mesh/refined_mesh.h"
#include "core/progress.h"
#include "core/scene.h"

namespace radiosity {

/// A triangle's level when the patch size decides.
inline constexpr std::int8_t kLevelFromPatchSize = -1;

struct SubdivideOptions {
  float patch_size = 0.0F;  ///< longest edge allowed, metres; 0 leaves edges as they are
  /// How often a triangle is cut in four, [triangle_count] or empty; kLevelFromPatchSize leaves it to `patch_size`.
  std::span<const std::int8_t> level_of_triangle;
  std::size_t max_elements = 20'000'000;  ///< subdivision ends before a round that would exceed this
};

/// The scene cut to size, and whether `max_elements` ended it early.
struct Subdivision {
  RefinedMesh mesh;
  bool reached_limit = false;
};

/// Every scene triangle is covered by its elements exactly, degenerate, duplicated, non-manifold and oppositely wound
/// ones included. Deterministic. Throws `Cancelled`.
Subdivision subdivide_uniform(const Scene& scene, const SubdivideOptions& options, const Progress& progress);

/// The same on a mesh that is to be cut further; its elements are left in the order of their numbers. Returns whether
/// the limit ended it early.
bool subdivide_uniform(CutMesh& cut, const SubdivideOptions& options, const Progress& progress);

/// A patch size that suits the scene: sqrt(surface area / 4000), metres.
float default_patch_size(const Scene& scene);

/// One that adaptive refinement may start from: a third of the diagonal, metres.
float coarse_patch_size(const Scene& scene);

}  // namespace radiosity
