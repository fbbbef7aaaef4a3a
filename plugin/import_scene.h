// glTF scene -> core scene, with the provenance that leads every vertex and triangle back.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene.h"
#include "plugin/document.h"
#include "plugin/import_materials.h"
#include "plugin/light_sources.h"
#include "plugin/scene_detail.h"

namespace gltf_radiosity {

/// One primitive of one node's mesh in the world. Ranges are half open.
struct PrimitiveInstance {
  std::uint32_t node = 0, mesh = 0, primitive = 0;
  std::uint32_t material = 0;                            ///< index into ImportedScene::materials
  std::uint32_t first_vertex = 0, vertex_count = 0;      ///< in Scene::positions
  std::uint32_t first_triangle = 0, triangle_count = 0;  ///< in Scene::triangles
  /// Gets COLOR_0; otherwise it only casts and sends light (select_nodes.h), is unlit or clear
  /// (ImportedMaterial::receives).
  bool receives = true;
  std::uint32_t copy = 0;  ///< which of the copies that EXT_mesh_gpu_instancing makes of the node's mesh
  bool mirrored = false;   ///< the node's world transform turns triangles over
  /// Which vertex of the glTF primitive each scene vertex is, [vertex_count]; empty means the same, in order. Differs
  /// for a primitive without normals, which glTF shades flat: a vertex between faces that crease is split.
  std::vector<std::uint32_t> source_vertex;
};

struct ImportedScene {
  radiosity::Scene scene;
  std::vector<PrimitiveInstance> instances;  ///< ascending ranges that tile the scene's vertices and triangles
  std::vector<ImportedMaterial> materials;   ///< one per glTF material in use, and the default one
  std::unique_ptr<SceneDetail> detail;       ///< scene.detail points here; looks into the vectors above and below
  std::vector<float>
      vertex_colors;  ///< the source's COLOR_0, linear RGBA, [vertex_count * 4]; ones where there is none
  std::vector<std::int8_t> level_of_triangle;  ///< subdivision overrides, [triangle_count]
  std::vector<LightSource> sources;            ///< each is a light group of the scene
  std::vector<std::uint32_t> node_of_light;    ///< of the first lights of `scene`, those of KHR_lights_punctual
  std::vector<std::string> light_groups;       ///< names (light_groups.h); empty if they are not kept apart
  std::uint64_t punctual_light_count = 0, emissive_triangle_count = 0;

  ImportedMaterial& material_of_surface(std::size_t surface) { return materials[detail->material_of_surface[surface]]; }
};

/// Walks a scene (options.scene; else the default, else the first, else every root): triangles, strips and fans of all
/// nodes in world space, their materials, lights, sky and sun. What moves is taken in its rest pose. Adds
/// warnings to `warnings`. "nothing to bake" is an error; so are a scene of more than 2^32 triangles or vertices
/// (ErrorCode::kLimit) and options that do not suit the file (kBadOption).
Result<ImportedScene> import_scene(const Document& document, const Options& options, std::vector<Warning>& warnings);

/// The same walk for a scene that is only to be looked at, as one that is baked already: everything may be unlit, and
/// nothing shines on it from outside. `scene` as in Options.
Result<ImportedScene> import_displayed(const Document& document, std::optional<std::uint32_t> scene,
                                       std::vector<Warning>& warnings);

}  // namespace gltf_radiosity
