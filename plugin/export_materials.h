// Materials that show COLOR_0 as it is, in every engine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>

#include "core/rgb.h"
#include "plugin/document.h"
#include "plugin/import_materials.h"
#include "plugin/shown_texture.h"

namespace gltf_radiosity {

inline constexpr const char* kUnlitExtension = "KHR_materials_unlit";
inline constexpr const char* kVariantsExtension = "KHR_materials_variants";

/// An unlit version of `source`, the JSON of the material that `material` was made of (an object without members for
/// glTF's default material). Kept: name, extras, base colour texture with its transform, alpha mode and cutoff,
/// doubleSided, alpha factor, extensions that do not shade. Set: KHR_materials_unlit, base colour 1, metallic 0,
/// roughness 1. Removed: emissive, normal, occlusion and metallic-roughness, and shading extensions.
/// `factor` is the base colour factor of what is not transparent: COLOR_0 was divided by it.
/// With ShownTexture::kEmissive the emissive texture takes the place of the base colour's.
Json unlit_material(const Json& source, const ImportedMaterial& material, const radiosity::Rgb& factor = {1, 1, 1},
                    ShownTexture texture = ShownTexture::kBaseColor);

/// `source` with its base colour factor, or the diffuse one of specular-glossiness, times `factor`; lit as it was.
Json dimmed_material(const Json& source, const radiosity::Rgb& factor);

/// Puts `baked`, made of `material`, into the document and returns its index. It takes the place of the source if
/// `referenced` (referenced_materials) does not name that, so that files carry no dead materials; otherwise it is
/// appended. Then `referenced` names it.
std::size_t export_material(Document& document, const ImportedMaterial& material, Json baked,
                            std::set<std::size_t>& referenced);

/// Every material that anything in the tree refers to by a member "material" or "materials", by an animation pointer or
/// as a level of detail.
std::set<std::size_t> referenced_materials(const Json& root);

/// Takes the names of shading extensions that no longer occur off extensionsUsed and extensionsRequired.
void forget_unused_material_extensions(Json& root);

}  // namespace gltf_radiosity
