#include "plugin/export_scene.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/reconstruct/exposure.h"
#include "plugin/export_colors.h"
#include "plugin/export_materials.h"
#include "plugin/export_meshes.h"
#include "plugin/instancing.h"
#include "plugin/our_extras.h"
#include "plugin/used_extensions.h"

namespace gltf_radiosity {
namespace {

constexpr const char* kVariantsOfPrimitive = "KHR_materials_variants";

/// How often each mesh is referred to by a member "mesh", anywhere in the tree.
void count_mesh_references(const Json& value, std::map<std::size_t, std::size_t>& counts) {
  if (value.is_object() && value.contains("mesh") && value["mesh"].is_number())
    ++counts[value["mesh"].get<std::size_t>()];
  if (!value.is_structured()) return;
  for (const Json& child : value) count_mesh_references(child, counts);
}

/// Gives every node that receives light a mesh that no other node uses; returns the mesh of each instance.
/// `nodes` are those of the instances.
std::vector<std::size_t> separate_meshes(Json& root, const std::vector<PrimitiveInstance>& instances,
                                         const std::vector<std::size_t>& nodes) {
  // Who is baked, and whether anybody else looks at the same mesh.
  std::map<std::size_t, std::set<std::size_t>> baked_nodes_of_mesh;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (instances[i].receives) baked_nodes_of_mesh[instances[i].mesh].insert(nodes[i]);
  }
  std::map<std::size_t, std::size_t> references;
  count_mesh_references(root, references);

  // Copies, before anything is edited.
  std::map<std::size_t, std::size_t> mesh_of_node;
  for (const auto& [mesh, baked_nodes] : baked_nodes_of_mesh) {
    bool in_place = references[mesh] == baked_nodes.size();
    for (const std::size_t node : baked_nodes) {
      if (!std::exchange(in_place, false)) {
        Json copy = root["meshes"][mesh];
        root["meshes"].push_back(std::move(copy));
        root["nodes"][node]["mesh"] = root["meshes"].size() - 1;
      }
      mesh_of_node[node] = root["nodes"][node]["mesh"].get<std::size_t>();
    }
  }
  std::vector<std::size_t> meshes;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const auto own = mesh_of_node.find(nodes[i]);
    meshes.push_back(own == mesh_of_node.end() ? instances[i].mesh : own->second);
  }
  return meshes;
}

/// A variant would show a material that is not unlit.
void drop_variants(Json& primitive, const PrimitiveInstance& instance, std::vector<Warning>& warnings) {
  if (!primitive.contains("extensions") || !primitive["extensions"].contains(kVariantsOfPrimitive)) return;
  remove_extension(primitive, kVariantsOfPrimitive);
  const std::string place = place_of_primitive(instance.mesh, instance.primitive);
  const bool said = std::any_of(warnings.begin(), warnings.end(), [&place](const Warning& warning) {
    return warning.code == "variants-dropped" && warning.place == place;
  });
  if (said) return;  // by another node with the same mesh
  warnings.push_back(
      {"variants-dropped", place, "the material variants of this primitive were dropped, the default one was baked"});
}

float exposure(const std::vector<VertexColors>& colors, const Options& options, ExportReport& report) {
  std::vector<radiosity::ExposureSample> samples;
  for (const VertexColors& primitive : colors) {
    samples.insert(samples.end(), primitive.samples.begin(), primitive.samples.end());
  }
  report.exposure = options.exposure.value_or(radiosity::automatic_exposure(samples));
  const auto k = static_cast<float>(report.exposure);
  report.clipped_share = static_cast<double>(radiosity::clipped_share(samples, k));
  return k;
}

/// Where a baked primitive is in the tree, and what it is made of.
struct BakedPrimitive {
  std::size_t mesh = 0, primitive = 0;
  std::uint32_t material = 0;
};

Json& primitive_json(Json& root, const BakedPrimitive& baked) {
  return root["meshes"][baked.mesh]["primitives"][baked.primitive];
}

void assign_materials(Document& document, const ImportedScene& scene, const std::vector<BakedPrimitive>& primitives) {
  for (const BakedPrimitive& baked : primitives) primitive_json(document.json, baked).erase("material");
  const std::set<std::size_t> referenced = referenced_materials(document.json);
  std::map<std::uint32_t, std::size_t> unlit;
  for (const BakedPrimitive& baked : primitives) {
    if (!unlit.contains(baked.material)) {
      unlit[baked.material] = export_unlit_material(document, scene.materials[baked.material], referenced);
    }
    primitive_json(document.json, baked)["material"] = unlit[baked.material];
  }
  forget_unused_material_extensions(document.json);
}

/// Files of one level can share an exposure that is written down.
void sign(Json& root, const ExportReport& report) {
  our_extras(root["asset"]) = {{"generator", "gltf-radiosity"},
                               {"version", version()},
                               {"exposure", report.exposure},
                               {"clipped", report.clipped_share}};
}

void count(const PrimitiveInstance& instance, const RefinedPrimitive& refined, ExportReport& report) {
  report.triangles += instance.receives ? refined.triangles.size() : instance.triangle_count;
  report.vertices += instance.receives ? refined.vertices.size() : instance.vertex_count;
}

}  // namespace

ExportReport export_scene(Document& document, BufferBuilder& buffer, const ImportedScene& scene,
                          const radiosity::Bake& bake, const Options& options, std::vector<Warning>& warnings) {
  // One exposure for everything.
  ExportReport report;
  const std::vector<RefinedPrimitive> refined = split_by_instance(bake.mesh, scene);
  const std::vector<VertexColors> colors = vertex_colors(scene, bake, refined);
  const float k = exposure(colors, options, report);

  // Geometry and colours.
  std::vector<BakedPrimitive> baked;
  const std::vector<std::size_t> nodes = expand_copies(document, scene.instances);
  const std::vector<std::size_t> meshes = separate_meshes(document.json, scene.instances, nodes);
  for (std::size_t i = 0; i < refined.size(); ++i) {
    const PrimitiveInstance& instance = scene.instances[i];
    count(instance, refined[i], report);
    if (!instance.receives) continue;
    baked.push_back({meshes[i], instance.primitive, instance.material});
    Json primitive = primitive_json(document.json, baked.back());
    drop_variants(primitive, instance, warnings);
    if (refined[i].changed) export_geometry(document, buffer, instance, refined[i], primitive);
    primitive["attributes"]["COLOR_0"] = export_color_accessor(document, buffer, colors[i], k, options.color_type);
    primitive_json(document.json, baked.back()) = std::move(primitive);
  }

  assign_materials(document, scene, baked);
  sign(document.json, report);
  return report;
}

}  // namespace gltf_radiosity
