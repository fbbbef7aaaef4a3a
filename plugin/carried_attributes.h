// What the vertices of a glTF carry, and how much of it --simplify may change: everything that will be exported.
#pragma once

#include <span>
#include <vector>

#include "core/bake.h"
#include "core/mesh/carried.h"
#include "plugin/document.h"
#include "plugin/export_colors.h"
#include "plugin/export_meshes.h"
#include "plugin/import_scene.h"

namespace gltf_radiosity {

/// COLOR_0 of all vertices, by instance, and the exposure k, m2/cd.
struct ExposedColors {
  std::span<const VertexColors> of_instance;
  float k = 1.0F;
};

/// How bright the baked surfaces show on average, as exposed and cut off at white, and how large they are, m2.
struct MeanColor {
  double luminance = 0.0;
  double area = 0.0;
};
MeanColor mean_color(const ExposedColors& colors);

/// Whether vertices of an instance may go: it receives light, and no extension may name its vertices by their numbers.
bool may_lose_vertices(const Document& document, const PrimitiveInstance& instance);

/// Carries every attribute and morph target of every instance that may lose vertices; those of others are fixed.
/// Tolerances:
///
/// - light: `max_error` of the mean COLOR_0, as exposed and cut off at white (but for a radiance attribute, which is
///   not); with ErrorSpace::kDisplay less in the dark, down to 0.7 of it
/// - shape: 1/10000 of the instance's extent, but 1/50000 of the scene's at most; for morph targets the same
/// - normals and tangents: 0.01; texture coordinates: 1/2048; colours and weights: 1/256; other values: 1/1024 of their
///   range in the primitive; but a step of the stored integers where that is more
///
/// Integers that name something, and the joints that a vertex follows, are labels.
radiosity::Carried carried_attributes(const Document& document, const ImportedScene& scene,
                                      const radiosity::RefinedMesh& mesh, std::span<const RefinedPrimitive> refined,
                                      const ExposedColors& colors, const Options& options);

}  // namespace gltf_radiosity
