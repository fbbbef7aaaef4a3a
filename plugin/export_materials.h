// Materials that show COLOR_0 as it is, in every engine.
#pragma once

#include <cstdint>
#include <optional>

#include "plugin/document.h"
#include "plugin/import_materials.h"

namespace gltf_radiosity {

/// Appends an unlit version of the source material (a clone, so that whatever else uses the source keeps it) and returns its
/// index; called once per source material. KHR_materials_unlit is declared as used, not required. Kept: name, extras, base
/// colour texture with its transform, alpha mode and cutoff, doubleSided, alpha factor. Set: base colour 1, metallic 0, roughness 1.
/// Removed: emissive, normal, occlusion and metallic-roughness, and shading extensions.
std::size_t export_unlit_material(Document& document, const ImportedMaterial& material);

}  // namespace gltf_radiosity
