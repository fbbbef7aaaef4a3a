// The baked light -> the glTF's tree: the whole export in one short function.
#pragma once

#include <cstdint>
#include <vector>

#include "core/bake.h"
#include "plugin/append_accessor.h"
#include "plugin/document.h"
#include "plugin/export_colors.h"
#include "plugin/export_light_groups.h"
#include "plugin/import_scene.h"
#include "plugin/simplify_scene.h"

namespace gltf_radiosity {

/// What was exported.
/// Where the colours of an instance went.
struct ExportedColors {
  std::uint32_t instance = 0;
  std::size_t mesh = 0, primitive = 0;  ///< in the output
  radiosity::Rgb factor{1.0F};          ///< COLOR_0 was divided by it
};

struct ExportReport {
  double exposure = 1.0;              ///< k, m2/cd
  double clipped_share = 0.0;         ///< of the baked area
  double texture_error = 0.0;         ///< TextureChoice::squared_error as root mean square over mean luminance
  std::uint64_t triangles = 0;        ///< of all instances, as stored
  std::uint64_t baked_triangles = 0;  ///< those that received light
  std::uint64_t vertices = 0;
  SimplifyReport simplified;
  std::vector<ExportedColors> colors;     ///< of the instances that received light
  std::vector<RefinedPrimitive> refined;  ///< [instance_count]
  std::vector<ShownTexture> textures;     ///< [material_count]
  GroupBytes group_bytes{};               ///< for LightGroupStorage::kFiles
};

/// What COLOR_0 holds beside the light.
ColorParts color_parts(const Options& options);

/// Gives every primitive instance that receives light its COLOR_0, an unlit material (or what options.target says) and,
/// where it was subdivided or simplified, its new geometry; new data goes into `buffer`. A mesh stays where it is for
/// its first baked node if only baked nodes use it; other nodes get copies. Instanced copies become nodes
/// (instancing.h). With options.light_groups the light of scene.light_groups goes beside the whole. What was done goes
/// into asset.extras.radiosity, warnings into `warnings`. Throws `Cancelled`.
ExportReport export_scene(Document& document, BufferBuilder& buffer, const ImportedScene& scene,
                          const radiosity::Bake& bake, const Options& options, std::vector<Warning>& warnings,
                          const radiosity::Progress& progress);

}  // namespace gltf_radiosity
