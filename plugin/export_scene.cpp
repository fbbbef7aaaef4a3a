#include "plugin/export_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/photometry.h"
#include "core/reconstruct/exposure.h"
#include "core/reconstruct/shown_light.h"
#include "plugin/export_colors.h"
#include "plugin/export_materials.h"
#include "plugin/export_meshes.h"
#include "plugin/instancing.h"
#include "plugin/json_checker.h"
#include "plugin/our_extras.h"
#include "plugin/output_style.h"
#include "plugin/used_extensions.h"

namespace gltf_radiosity {
namespace {

using radiosity::Rgb;

/// How often each mesh is referred to by a member "mesh", anywhere in the tree.
void count_mesh_references(const Json& value, std::map<std::size_t, std::size_t>& counts) {
  if (value.is_object() && value.contains("mesh")) {
    if (const auto mesh = whole_number(value["mesh"])) ++counts[*mesh];
  }
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
  if (!primitive.contains("extensions") || !primitive["extensions"].contains(kVariantsExtension)) return;
  remove_extension(primitive, kVariantsExtension);
  const std::string place = place_of_primitive(instance.mesh, instance.primitive);
  const bool said = std::any_of(warnings.begin(), warnings.end(), [&place](const Warning& warning) {
    return warning.code == "variants-dropped" && warning.place == place;
  });
  if (said) return;  // by another node with the same mesh
  warnings.push_back(
      {"variants-dropped", place, "the material variants of this primitive were dropped, the default one was baked"});
}

/// Those of each light group, [light_groups.size()], or empty.
std::vector<VertexColors> colors_of_groups(const ImportedScene& scene, const radiosity::Bake& bake,
                                           const RefinedPrimitive& refined, std::size_t instance,
                                           const Options& options, const std::vector<ShownTexture>& textures) {
  std::vector<VertexColors> colors;
  for (std::uint32_t group = 0; group < scene.light_groups.size(); ++group) {
    colors.push_back(group_colors(scene, bake, refined, static_cast<std::uint32_t>(instance), color_parts(options),
                                  textures[scene.instances[instance].material], group));
  }
  return colors;
}

/// Of what elements display, what is brighter than `white` (cd/m2) cut off.
struct Displayed {
  double area = 0.0, luminance = 0.0;  ///< m2, mean in cd/m2
};

Displayed displayed(const ImportedScene& scene, const radiosity::Bake& bake,
                    const std::vector<RefinedPrimitive>& refined, float white) {
  const radiosity::ShownLight shown = radiosity::shown_light(scene.scene, bake.mesh);
  Displayed all;
  for (std::size_t i = 0; i < refined.size(); ++i) {
    if (!scene.instances[i].receives) continue;
    for (const std::uint32_t e : refined[i].elements) {
      const glm::uvec3& corner = bake.mesh.elements[e];
      const Rgb light = bake.irradiance[corner.x] + bake.irradiance[corner.y] + bake.irradiance[corner.z];
      const auto area = double{element_area(bake.mesh, e)};
      all.area += area;
      all.luminance += area * double{radiosity::luminance_of(glm::min(shown.under(e, light / 3.0F), Rgb(white)))};
    }
  }
  if (all.area > 0.0) all.luminance /= all.area;
  return all;
}

/// All colours, with the texture that suits each material, and the exposure they want.
std::vector<VertexColors> exposed_colors(const ImportedScene& scene, const radiosity::Bake& bake,
                                         const std::vector<RefinedPrimitive>& refined, const Options& options,
                                         std::vector<ShownTexture>& textures, ExportReport& report) {
  const ColorParts parts = color_parts(options);
  std::vector<VertexColors> colors = vertex_colors(scene, bake, refined, parts);
  report.exposure = options.exposure.value_or(radiosity::automatic_exposure(samples_of(colors)));
  const auto k = static_cast<float>(report.exposure);
  textures.assign(scene.materials.size(), ShownTexture::kBaseColor);
  if (parts.emission && k > 0.0F) {
    TextureChoice choice = choose_textures(scene, bake, refined, 1.0F / k);
    textures = std::move(choice.shown);
    const Displayed all = choice.squared_error > 0.0 ? displayed(scene, bake, refined, 1.0F / k) : Displayed{};
    if (all.luminance > 0.0) report.texture_error = std::sqrt(choice.squared_error / all.area) / all.luminance;
  }
  if (std::ranges::count(textures, ShownTexture::kEmissive) > 0) {
    colors = vertex_colors(scene, bake, refined, parts, textures);
  }
  report.clipped_share = static_cast<double>(radiosity::clipped_share(samples_of(colors), k));
  return colors;
}

/// Where a baked primitive is in the tree, and what it is made of.
struct BakedPrimitive {
  std::size_t mesh = 0, primitive = 0;
  std::uint32_t material = 0;
  Rgb factor{1.0F};  ///< COLOR_0 was divided by it
};

Json& primitive_json(Json& root, const BakedPrimitive& baked) {
  return root["meshes"][baked.mesh]["primitives"][baked.primitive];
}

/// The material of a baked primitive: the source's JSON -> the output's; none if it stays as it is.
std::optional<Json> baked_material(const Json& source, const ImportedMaterial& material, const Rgb& factor,
                                   ShownTexture texture, Target target) {
  if (target == Target::kUnlit) return unlit_material(source, material, factor, texture);
  if (factor == Rgb(1.0F)) return std::nullopt;
  return dimmed_material(source, factor);
}

/// What shows its light can no longer be seen through.
void warn_of_transmission(const ImportedMaterial& material, std::vector<Warning>& warnings) {
  if (!material.source || !material.transmission) return;
  warnings.push_back({"transmission-opaque", place_of("materials", *material.source),
                      "lets light through, but once baked nothing is seen through it: unlit knows no transmission"});
}

void assign_materials(Document& document, const ImportedScene& scene, const std::vector<BakedPrimitive>& primitives,
                      const std::vector<ShownTexture>& textures, Target target, std::vector<Warning>& warnings) {
  // What stays as it is, and what others look at.
  Json& root = document.json;
  const Json sources = root.value("materials", Json::array());
  const auto source_of = [&](const BakedPrimitive& baked) {
    const auto source = scene.materials[baked.material].source;
    return source ? sources[*source] : Json::object();
  };
  const auto change_of = [&](const BakedPrimitive& baked) {
    return baked_material(source_of(baked), scene.materials[baked.material], baked.factor, textures[baked.material],
                          target);
  };
  for (const BakedPrimitive& baked : primitives) {
    if (change_of(baked)) primitive_json(root, baked).erase("material");
  }
  std::set<std::size_t> referenced = referenced_materials(root);

  // The others.
  std::map<std::tuple<std::uint32_t, float, float, float>, std::size_t> known;
  std::map<std::uint32_t, std::size_t> version_count;
  for (const BakedPrimitive& baked : primitives) {
    std::optional<Json> change = change_of(baked);
    if (!change) continue;
    const auto key = std::tuple(baked.material, baked.factor.x, baked.factor.y, baked.factor.z);
    if (!known.contains(key)) {
      if (target == Target::kUnlit && version_count[baked.material] == 0) {
        warn_of_transmission(scene.materials[baked.material], warnings);
      }
      // Importers that keep materials in files of their own tell them apart by name.
      const std::size_t version = ++version_count[baked.material];
      if (version > 1 && change->contains("name") && (*change)["name"].is_string()) {
        (*change)["name"] = fmt::format("{}.{}", (*change)["name"].get<std::string>(), version);
      }
      known[key] = export_material(document, scene.materials[baked.material], std::move(*change), referenced);
    }
    primitive_json(root, baked)["material"] = known[key];
  }
  if (target == Target::kUnlit && !primitives.empty()) declare_extension(root, kUnlitExtension);
  forget_unused_material_extensions(root);
}

/// Files of one level can share an exposure that is written down.
void sign(Json& root, const ExportReport& report, const Options& options) {
  Json& signature = our_extras(root["asset"]);
  signature = {{"generator", "gltf-radiosity"},
               {"version", version()},
               {"exposure", report.exposure},
               {"clipped", report.clipped_share}};
  if (options.bake != BakedLight::kBoth) signature["light"] = name_of(options.bake);
  if (options.target == Target::kKeep) signature["target"] = "keep";
  if (!options.radiance_attribute.empty()) signature["radiance"] = radiance_semantic(options);
}

void count(const PrimitiveInstance& instance, const RefinedPrimitive& refined, ExportReport& report) {
  report.triangles += instance.receives ? refined.triangles.size() : instance.triangle_count;
  report.baked_triangles += instance.receives ? refined.triangles.size() : 0;
  report.vertices += instance.receives ? refined.written_vertex_count() : instance.vertex_count;
}

}  // namespace

ColorParts color_parts(const Options& options) {
  const bool unlit = options.target == Target::kUnlit;
  return {unlit, unlit && options.bake != BakedLight::kIndirect};
}

ExportReport export_scene(Document& document, BufferBuilder& buffer, const ImportedScene& scene,
                          const radiosity::Bake& bake, const Options& options, std::vector<Warning>& warnings,
                          const radiosity::Progress& progress) {
  // One exposure for everything.
  ExportReport report;
  std::vector<RefinedPrimitive> refined = split_by_instance(bake.mesh, scene);
  const bool unlit = options.target == Target::kUnlit;
  std::vector<ShownTexture> textures;
  const std::vector<VertexColors> colors = exposed_colors(scene, bake, refined, options, textures, report);
  const auto k = static_cast<float>(report.exposure);

  // Only what is needed.
  if (options.simplify) {
    warn_of_named_vertices(document, scene, warnings);
    report.simplified = simplify_scene(document, scene, bake, {colors, k}, options, refined, progress);
  }

  // Geometry and colours.
  progress.update("export", 0.0);
  const OutputStyle style = output_style(options);
  GroupExport groups{document, buffer, options.light_groups, style.color_type,
                     group_names(document.json, scene.light_groups)};
  std::vector<BakedPrimitive> baked;
  const std::vector<std::size_t> nodes = expand_copies(document, scene.instances);
  const std::vector<std::size_t> meshes = separate_meshes(document.json, scene.instances, nodes);
  for (std::size_t i = 0; i < refined.size(); ++i) {
    const PrimitiveInstance& instance = scene.instances[i];
    count(instance, refined[i], report);
    if (!instance.receives) continue;
    const Rgb factor = style.scale_to_factor ? brightest(colors[i], refined[i].kept, k) : Rgb(1.0F);
    baked.push_back({meshes[i], instance.primitive, instance.material, factor});
    report.colors.push_back({static_cast<std::uint32_t>(i), meshes[i], instance.primitive, factor});
    Json primitive = primitive_json(document.json, baked.back());
    if (unlit || factor != Rgb(1.0F)) drop_variants(primitive, instance, warnings);
    if (refined[i].changed) export_geometry(document, buffer, instance, refined[i], primitive);
    primitive["attributes"]["COLOR_0"] =
        export_color_accessor(document, buffer, colors[i], refined[i].kept, k / factor, style.color_type);
    note_reflectance(colors[i], primitive);
    export_group_colors(groups, colors[i], colors_of_groups(scene, bake, refined[i], i, options, textures),
                        refined[i].kept, k / factor, meshes[i], primitive);
    if (!options.radiance_attribute.empty()) {
      primitive["attributes"][radiance_semantic(options)] =
          export_radiance_accessor(document, buffer, colors[i], refined[i].kept, k);
    }
    primitive_json(document.json, baked.back()) = std::move(primitive);
  }

  assign_materials(document, scene, baked, textures, options.target, warnings);
  sign(document.json, report, options);
  report.refined = std::move(refined);
  report.textures = std::move(textures);
  finish_groups(groups, warnings);
  report.group_bytes = std::move(groups.bytes);
  return report;
}

}  // namespace gltf_radiosity
