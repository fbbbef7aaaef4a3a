// --simplify: what the export leaves out of the refined mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "core/bake.h"
#include "core/progress.h"
#include "plugin/carried_attributes.h"
#include "plugin/document.h"
#include "plugin/export_meshes.h"
#include "plugin/import_scene.h"

namespace gltf_radiosity {

struct SimplifyReport {
  std::uint64_t removed_vertices = 0;
  double light_change = 0.0;  ///< root mean square over mean of COLOR_0's luminance
};

/// Takes out of `refined` the vertices that nothing needs (core/mesh/simplify.h, carried_attributes.h): fills in `kept`
/// and replaces `triangles` and `elements` of instances that lose any. `colors` stay those of all vertices. Throws
/// `Cancelled`.
SimplifyReport simplify_scene(const Document& document, const ImportedScene& scene, const radiosity::Bake& bake,
                              const ExposedColors& colors, const Options& options,
                              std::vector<RefinedPrimitive>& refined, const radiosity::Progress& progress);

/// Warns of primitives that keep their vertices because an extension may name them by their numbers.
void warn_of_named_vertices(const Document& document, const ImportedScene& scene, std::vector<Warning>& warnings);

}  // namespace gltf_radiosity
