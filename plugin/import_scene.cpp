#include "plugin/import_scene.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/finite.h"
#include "plugin/accessor_view.h"
#include "plugin/check_document.h"
#include "plugin/import_geometry.h"
#include "plugin/import_lights.h"
#include "plugin/import_nodes.h"
#include "plugin/import_sky.h"
#include "plugin/instancing.h"
#include "plugin/select_nodes.h"

namespace gltf_radiosity {
namespace {

using radiosity::Rgb;

constexpr std::size_t kMaxCount = radiosity::kNothing - 1;

/// What a vertex and a triangle of the scene take from import to export at the highest: a million triangles with half
/// as many vertices took 466 MiB in all.
constexpr std::uint64_t kBytesPerVertex = 200, kBytesPerTriangle = 400;

/// Turns normals as the inverse transpose does, also where there is no inverse: the cofactors, with the sign of the
/// determinant.
glm::dmat3 normal_transform(const glm::dmat3& m) {
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  return glm::determinant(m) < 0.0 ? -1.0 * cofactors : cofactors;
}

glm::vec3 unit_or_zero(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0.0 && std::isfinite(length) ? glm::vec3(v / length) : glm::vec3(0.0F);
}

/// How much of something there is, and where the first of it lies.
struct Found {
  std::uint64_t count = 0;
  std::string first;

  void add(std::uint64_t more, std::string place) {
    if (count == 0 && more > 0) first = std::move(place);
    count += more;
  }
};

/// Makes the scene, part by part. `run` reads as the recipe.
class SceneImporter {
 public:
  SceneImporter(const Document& document, const tinygltf::Model& model, const Options& options,
                std::vector<Warning>& warnings)
      : document_(document), model_(model), options_(options), warnings_(warnings), textures_(document, warnings) {}

  Result<ImportedScene> run() {
    if (auto done = import_surfaces(); !done) return done.error();
    if (auto done = check_that_there_is_work(); !done) return done.error();
    count_emissive_triangles();
    if (auto done = import_environment(); !done) return done.error();
    name_emissive_materials();
    warn();
    return std::move(result_);
  }

  Result<ImportedScene> run_without_light() {
    if (auto done = import_surfaces(); !done) return done.error();
    return std::move(result_);
  }

 private:
  // Nodes.

  Result<Done> import_surfaces() {
    auto placed = place_nodes(document_, model_, options_, warnings_);
    if (!placed) return placed.error();
    auto receives = receiving_nodes(document_, placed->visible, options_, warnings_);
    if (!receives) return receives.error();
    node_receives_ = std::move(*receives);
    if (auto fits = reserve_scene(*placed); !fits) return fits;
    for (const std::uint32_t node : placed->visible) {
      if (auto done = import_node(*placed, node); !done) return done.error();
    }
    finish_detail();
    return Done{};
  }

  Result<Done> import_node(const PlacedNodes& placed, std::uint32_t node) {
    const Json& json = document_.json["nodes"][node];
    if (const Json* light = extension_of(json, "KHR_lights_punctual")) {
      import_punctual_light(*light, node, placed.world_from_node[node]);
      if (!radiosity::is_in_reach(result_.scene.lights.back().position)) {
        return bad_input(place_of("nodes", node), "its light lies beyond 1e8 m");
      }
    }
    const int mesh = model_.nodes[node].mesh;
    if (mesh < 0) return Done{};
    if (model_.nodes[node].skin >= 0 && instancing_of(document_, node) != nullptr) {
      return bad_input(place_of("nodes", node), "EXT_mesh_gpu_instancing does not say where skinned copies stand");
    }
    std::uint32_t copy = 0;
    for (const glm::dmat4& node_from_copy : copy_transforms(document_, node)) {
      if (auto done = import_copy(placed, {node, copy++, placed.world_from_node[node] * node_from_copy}); !done) {
        return done.error();
      }
    }
    return Done{};
  }

  /// One of the copies of a node's mesh; nodes without EXT_mesh_gpu_instancing have one.
  struct Copy {
    std::uint32_t node = 0, number = 0;
    glm::dmat4 world_from_mesh{1.0};
  };

  /// Sets memory aside for everything that nodes show, by what accessors say, before anything is read.
  Result<Done> reserve_scene(const PlacedNodes& placed) {
    for (const std::uint32_t node : placed.visible) {
      if (model_.nodes[node].mesh < 0) continue;
      const auto mesh = static_cast<std::size_t>(model_.nodes[node].mesh);
      std::uint64_t copies = 1;
      if (const Json* instancing = instancing_of(document_, node)) {
        constexpr std::uint64_t kBytesPerCopy = 4096;  // it becomes a node of its own
        copies = count_of((*instancing)["attributes"].front().get<std::size_t>());
        auto fits = document_.memory->reserve(copies, kBytesPerCopy, place_of("nodes", node), "instances");
        if (!fits) return fits;
      }
      for (std::size_t primitive = 0; primitive < model_.meshes[mesh].primitives.size(); ++primitive) {
        if (auto fits = reserve_primitive(node, mesh, primitive, copies); !fits) return fits;
      }
    }
    return Done{};
  }

  Result<Done> reserve_primitive(std::uint32_t node, std::size_t mesh, std::size_t primitive, std::uint64_t copies) {
    const tinygltf::Primitive& source = model_.meshes[mesh].primitives[primitive];
    const auto position = source.attributes.find("POSITION");
    if (position == source.attributes.end() || !has_triangles(model_, mesh, primitive)) return Done{};
    const std::uint64_t vertex_count = count_of(static_cast<std::size_t>(position->second));
    const std::uint64_t corner_count =
        source.indices >= 0 ? count_of(static_cast<std::size_t>(source.indices)) : vertex_count;
    const std::uint64_t triangle_count = source.mode == TINYGLTF_MODE_TRIANGLES ? corner_count / 3 : corner_count;
    const std::uint64_t bytes = vertex_count * kBytesPerVertex + triangle_count * kBytesPerTriangle;
    MemoryBudget& memory = *document_.memory;
    if (memory.check(copies, bytes, "", "")) return memory.reserve(copies, bytes, "", "");
    return memory.reserve(copies, bytes, fmt::format("{} of nodes[{}]", place_of_primitive(mesh, primitive), node),
                          fmt::format("times {} vertices and {} triangles", vertex_count, triangle_count));
  }

  std::uint64_t count_of(std::size_t accessor) const {
    return document_.json["accessors"][accessor]["count"].get<std::uint64_t>();
  }

  Result<Done> import_copy(const PlacedNodes& placed, const Copy& copy) {
    const auto mesh = static_cast<std::size_t>(model_.nodes[copy.node].mesh);
    for (std::size_t primitive = 0; primitive < model_.meshes[mesh].primitives.size(); ++primitive) {
      if (!has_triangles(model_, mesh, primitive)) {
        if (copy.number == 0) skipped_primitives_.add(1, place_of_primitive(mesh, primitive));
        continue;
      }
      if (auto done = import_instance(placed, copy, primitive); !done) return done.error();
    }
    return Done{};
  }

  Result<Done> import_instance(const PlacedNodes& placed, const Copy& copy, std::size_t primitive) {
    const std::uint32_t node = copy.node;
    // What it is made of.
    const auto mesh = static_cast<std::size_t>(model_.nodes[node].mesh);
    const Result<std::uint32_t> material = material_index(model_.meshes[mesh].primitives[primitive].material);
    if (!material) return material.error();
    const Result<const PrimitiveGeometry*> geometry = geometry_of(node, mesh, primitive, *material);
    if (!geometry) return geometry.error();
    const PrimitiveGeometry& source = **geometry;
    if (source.triangles.empty()) return Done{};
    radiosity::Scene& scene = result_.scene;
    if (scene.positions.size() + source.positions.size() > kMaxCount ||
        scene.triangles.size() + source.triangles.size() > kMaxCount) {
      return Error{ErrorCode::kLimit, place_of("nodes", node), "the scene has more than 2^32 vertices or triangles"};
    }

    // Where it comes from.
    PrimitiveInstance instance;
    instance.node = node;
    instance.mesh = static_cast<std::uint32_t>(mesh);
    instance.primitive = static_cast<std::uint32_t>(primitive);
    instance.copy = copy.number;
    instance.material = *material;
    instance.first_vertex = static_cast<std::uint32_t>(scene.positions.size());
    instance.vertex_count = static_cast<std::uint32_t>(source.positions.size());
    instance.first_triangle = static_cast<std::uint32_t>(scene.triangles.size());
    instance.triangle_count = static_cast<std::uint32_t>(source.triangles.size());
    instance.receives = result_.materials[*material].receives() && node_receives_[node] != 0;
    instance.source_vertex = source.source_vertex;

    // Where it stands.
    const std::vector<glm::dmat4> joints = world_from_bind(placed, node);
    if (joints.empty() || source.weights.empty()) {
      instance.mirrored = glm::determinant(glm::dmat3(copy.world_from_mesh)) < 0.0;
      place_vertices(source, {&copy.world_from_mesh, 1});
    } else {
      instance.mirrored = glm::determinant(glm::dmat3(joints[0])) < 0.0;
      place_vertices(source, skin_transforms(source, joints));
      moves_ = true;
    }
    const auto first = scene.positions.begin() + instance.first_vertex;
    if (!std::all_of(first, scene.positions.end(), radiosity::is_in_reach)) {
      return bad_input(place_of("nodes", node), "its vertices lie beyond 1e8 m");
    }

    add_triangles(source, instance, placed.level[node]);
    add_texcoords(source);
    bad_normals_.add(source.recomputed_normals, place_of_primitive(mesh, primitive));
    result_.instances.push_back(std::move(instance));
    return Done{};
  }

  /// The matrices of a node's skin: mesh space in bind pose to world. Empty without a skin.
  std::vector<glm::dmat4> world_from_bind(const PlacedNodes& placed, std::uint32_t node) const {
    const int index = model_.nodes[node].skin;
    if (index < 0) return {};
    const tinygltf::Skin& skin = model_.skins[static_cast<std::size_t>(index)];
    std::vector<float> inverse_bind;
    if (skin.inverseBindMatrices >= 0) {
      inverse_bind = as_floats(read_accessor(document_, static_cast<std::size_t>(skin.inverseBindMatrices)));
    }
    std::vector<glm::dmat4> matrices;
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
      const glm::dmat4& world = placed.world_from_node[static_cast<std::size_t>(skin.joints[i])];
      matrices.push_back(inverse_bind.empty() ? world
                                              : world * glm::dmat4(glm::make_mat4(inverse_bind.data() + i * 16)));
    }
    return matrices;
  }

  // Geometry.

  /// Primitives that several nodes use are read once, unless each morphs them its own way.
  Result<const PrimitiveGeometry*> geometry_of(std::uint32_t node, std::size_t mesh, std::size_t primitive,
                                               std::uint32_t material) {
    const std::vector<double>& own = model_.nodes[node].weights;
    const std::vector<double>& weights = own.empty() ? model_.meshes[mesh].weights : own;
    moves_ = moves_ || !model_.meshes[mesh].primitives[primitive].targets.empty();
    const auto key = std::tuple(mesh, primitive, weights);
    const auto known = geometries_.find(key);
    if (known != geometries_.end()) return &known->second;

    const ImportedMaterial& used = result_.materials[material];
    std::set<int> texcoords;
    for (const TextureSlot* slot : used.textures()) {
      if (*slot) texcoords.insert(slot->texcoord);
    }
    auto geometry = read_primitive(document_, model_, mesh, primitive, texcoords, weights);
    if (!geometry) return geometry.error();
    return &geometries_.emplace(key, std::move(*geometry)).first->second;
  }

  /// Appends the vertices; one transform for all, or one for each.
  void place_vertices(const PrimitiveGeometry& source, std::span<const glm::dmat4> transforms) {
    radiosity::Scene& scene = result_.scene;
    const std::size_t count = source.positions.size();
    const bool shared = transforms.size() == 1;
    glm::dmat3 turn = normal_transform(glm::dmat3(transforms[0]));
    for (std::size_t v = 0; v < count; ++v) {
      const glm::dmat4& transform = transforms[shared ? 0 : v];
      if (!shared) turn = normal_transform(glm::dmat3(transform));
      scene.positions.emplace_back(transform * glm::dvec4(source.positions[v], 1.0));
      scene.normals.push_back(unit_or_zero(turn * glm::dvec3(source.normals[v])));
    }
    if (source.colors.empty()) {
      result_.vertex_colors.insert(result_.vertex_colors.end(), count * 4, 1.0F);
    } else {
      const float* colors = &source.colors[0].x;
      result_.vertex_colors.insert(result_.vertex_colors.end(), colors, colors + count * 4);
    }
  }

  void add_triangles(const PrimitiveGeometry& source, const PrimitiveInstance& instance, std::int8_t level) {
    radiosity::Scene& scene = result_.scene;
    const std::uint32_t surface = surface_index(instance.material, !source.colors.empty());
    for (const glm::uvec3& corners : source.triangles) {
      const glm::uvec3 wound = instance.mirrored ? glm::uvec3(corners.x, corners.z, corners.y) : corners;
      scene.triangles.push_back(wound + instance.first_vertex);
    }
    scene.surface_of_triangle.resize(scene.triangles.size(), surface);
    result_.level_of_triangle.resize(scene.triangles.size(), level);
  }

  void add_texcoords(const PrimitiveGeometry& source) {
    const std::size_t vertex_count = result_.scene.positions.size();
    for (const auto& [set, uv] : source.texcoords) {
      if (texcoords_.size() <= static_cast<std::size_t>(set)) texcoords_.resize(static_cast<std::size_t>(set) + 1);
      std::vector<glm::vec2>& all = texcoords_[static_cast<std::size_t>(set)];
      all.resize(vertex_count - uv.size());
      all.insert(all.end(), uv.begin(), uv.end());
    }
  }

  // Materials.

  Result<std::uint32_t> material_index(int source) {
    const auto known = material_of_source_.find(source);
    if (known != material_of_source_.end()) return known->second;
    const auto index = source < 0 ? std::nullopt : std::optional(static_cast<std::uint32_t>(source));
    auto material = import_material(document_, model_, index, options_.metals, textures_);
    if (!material) return material.error();
    result_.materials.push_back(std::move(*material));
    const auto added = static_cast<std::uint32_t>(result_.materials.size() - 1);
    material_of_source_[source] = added;
    return added;
  }

  /// Primitives with COLOR_0 have surfaces of their own, so that those without stay constant.
  std::uint32_t surface_index(std::uint32_t material_index, bool has_colors) {
    const auto key = std::pair(material_index, has_colors);
    const auto known = surface_of_material_.find(key);
    if (known != surface_of_material_.end()) return known->second;

    const ImportedMaterial& material = result_.materials[material_index];
    radiosity::Surface surface;
    surface.two_sided = material.double_sided;
    surface.see_through = may_let_light_through(material, has_colors);
    surface.reflectance = Rgb(0.0F);
    if (!material.unlit) {
      // What lets light through is asked at each hit anyhow.
      const auto textures = material.textures();
      const bool textured =
          std::any_of(textures.begin(), textures.end(), [](const TextureSlot* slot) { return !!*slot; });
      surface.reflectance = Rgb(material.base_color_factor) * material.diffuse_share(1.0F);
      surface.emission = material.emissive;
      surface.undyed_reflectance = Rgb(material.diffuse_share(1.0F));
      surface.varies = has_colors || textured || material.transmission;
    }
    const auto index = static_cast<std::uint32_t>(result_.scene.surfaces.size());
    result_.scene.surfaces.push_back(surface);
    material_of_surface_.push_back(material_index);
    surface_has_colors_.push_back(has_colors ? 1 : 0);
    surface_of_material_[key] = index;
    return index;
  }

  static bool may_let_light_through(const ImportedMaterial& material, bool has_colors) {
    if (material.transmission && !material.unlit) return true;
    if (material.alpha_mode == AlphaMode::kOpaque) return false;
    if (material.base_color || has_colors) return true;
    const float opaque_from = material.alpha_mode == AlphaMode::kMask ? material.alpha_cutoff : 1.0F;
    return material.base_color_factor.w < opaque_from;
  }

  // Light.

  void import_punctual_light(const Json& reference, std::uint32_t node, const glm::dmat4& world_from_node) {
    if (!unit_factor_) unit_factor_ = light_unit_factor(document_, options_.light_units, warnings_);
    const Json& lights = document_.json["extensions"]["KHR_lights_punctual"]["lights"];
    const auto index = reference["light"].get<std::uint32_t>();
    const auto name = document_.json["nodes"][node].value("name", std::string());
    result_.scene.lights.push_back(import_light(lights[index], world_from_node, *unit_factor_));
    result_.scene.lights.back().light_group = source_of_light(lights, index, name);
    result_.node_of_light.push_back(node);
    ++result_.punctual_light_count;
  }

  /// Nodes that hold one light are one source.
  std::uint32_t source_of_light(const Json& lights, std::uint32_t index, const std::string& node) {
    const auto [known, is_new] =
        source_of_light_.try_emplace(index, static_cast<std::uint32_t>(result_.sources.size()));
    if (is_new) {
      const std::string name = lights[index].value("name", std::string());
      result_.sources.push_back({.kind = LightSource::Kind::kLight,
                                 .name = name.empty() ? place_of("lights", index) : name,
                                 .nodes = {},
                                 .source = index,
                                 .strength = strength_of_light(lights[index]),
                                 .color = color_of_light(lights[index]),
                                 .core_units = *unit_factor_});
    }
    if (!node.empty()) result_.sources[known->second].nodes.push_back(node);
    return known->second;
  }

  std::uint32_t add_source(LightSource::Kind kind, std::string name, const Rgb& strength) {
    result_.sources.push_back({.kind = kind, .name = std::move(name), .nodes = {}, .source = {}, .strength = strength});
    return static_cast<std::uint32_t>(result_.sources.size() - 1);
  }

  void name_emissive_materials() {
    std::map<std::uint32_t, std::uint32_t> source_of_material;
    for (std::uint32_t m = 0; m < result_.materials.size(); ++m) {
      const ImportedMaterial& material = result_.materials[m];
      if (!material.emits() || material.unlit) continue;
      const Json& json = document_.json["materials"][*material.source];
      const std::string name = json.value("name", std::string());
      source_of_material[m] =
          add_source(LightSource::Kind::kMaterial, name.empty() ? place_of("materials", *material.source) : name,
                     material.emissive);
      result_.sources.back().source = material.source;
    }
    for (std::size_t s = 0; s < result_.scene.surfaces.size(); ++s) {
      const auto source = source_of_material.find(material_of_surface_[s]);
      if (source != source_of_material.end()) result_.scene.surfaces[s].light_group = source->second;
    }
  }

  Result<Done> import_environment() {
    radiosity::Scene& scene = result_.scene;
    auto sky = import_sky(document_, options_, warnings_);
    if (!sky) return sky.error();
    if (*sky) {
      scene.sky = std::move(**sky);
      const Rgb strength = scene.sky.has_map() ? Rgb(1.0F) : scene.sky.luminance;
      scene.sky.light_group = add_source(LightSource::Kind::kSky, "sky", strength);
    }
    if (options_.sun) {
      const Sun& sun = *options_.sun;
      const bool fine = std::isfinite(sun.elevation_degrees) && std::isfinite(sun.azimuth_degrees) &&
                        sun.illuminance_lux >= 0.0 && sun.illuminance_lux < 1e30;
      if (!fine) return Error{ErrorCode::kBadOption, "sun", "is negative or not finite"};
      scene.lights.push_back(import_sun(sun));
      scene.lights.back().light_group = add_source(LightSource::Kind::kSun, "sun", scene.lights.back().intensity);
    }
    const bool has_lights = std::any_of(scene.lights.begin(), scene.lights.end(),
                                        [](const radiosity::Light& light) { return light.intensity != Rgb(0.0F); });
    if (has_lights || result_.emissive_triangle_count > 0 || *sky || options_.sun || !options_.default_sky)
      return Done{};
    scene.sky.luminance = Rgb(1.0F);
    scene.sky.light_group = add_source(LightSource::Kind::kSky, "sky", scene.sky.luminance);
    warnings_.push_back({"default-sky", "", "the scene has no light; a white sky of 1 cd/m2 was put around it"});
    return Done{};
  }

  void count_emissive_triangles() {
    const radiosity::Scene& scene = result_.scene;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
      const radiosity::Surface& surface = scene.surfaces[scene.surface_of_triangle[t]];
      if (surface.emission == Rgb(0.0F)) continue;
      const bool textured =
          static_cast<bool>(result_.materials[material_of_surface_[scene.surface_of_triangle[t]]].emissive_texture);
      if (!textured || radiosity::mean_emission(scene, t, {}) != Rgb(0.0F)) ++result_.emissive_triangle_count;
    }
  }

  // The rest.

  Result<Done> check_that_there_is_work() const {
    if (result_.scene.triangles.empty()) return bad_input("", "nothing to bake: the scene has no triangles");
    const bool any = std::any_of(result_.instances.begin(), result_.instances.end(),
                                 [](const PrimitiveInstance& instance) { return instance.receives; });
    if (any) return Done{};
    const bool all_shown = std::none_of(
        result_.instances.begin(), result_.instances.end(),
        [&](const PrimitiveInstance& instance) { return result_.materials[instance.material].receives(); });
    return bad_input("", all_shown ? "nothing to bake: every material of the scene is unlit or clear"
                                   : "nothing to bake: no node with a material that is lit receives light");
  }

  void finish_detail() {
    geometries_.clear();
    for (std::vector<glm::vec2>& uv : texcoords_) {
      if (!uv.empty()) uv.resize(result_.scene.positions.size());
    }
    auto detail = std::make_unique<SceneDetail>();
    detail->triangles = result_.scene.triangles;
    detail->surface_of_triangle = result_.scene.surface_of_triangle;
    detail->vertex_colors = result_.vertex_colors;
    detail->materials = result_.materials;
    detail->material_of_surface = std::move(material_of_surface_);
    material_of_surface_ = detail->material_of_surface;
    detail->surface_has_colors = std::move(surface_has_colors_);
    detail->texcoords = std::move(texcoords_);
    result_.detail = std::move(detail);
    result_.scene.detail = result_.detail.get();
  }

  void warn() {
    if (bad_normals_.count > 0) {
      warnings_.push_back(
          {"bad-normals", bad_normals_.first,
           fmt::format("{} normals were zero or not finite and were recomputed from the faces", bad_normals_.count)});
    }
    if (skipped_primitives_.count > 0) {
      warnings_.push_back(
          {"points-and-lines", skipped_primitives_.first,
           fmt::format("{} primitives of points or lines take no part in the light", skipped_primitives_.count)});
    }
    if (moves_ || !array_of(document_.json, "animations").empty()) {
      warnings_.push_back({"rest-pose", "", "what animations, skins or morph targets move is lit in its rest pose"});
    }
  }

  const Document& document_;
  const tinygltf::Model& model_;
  const Options& options_;
  std::vector<std::uint8_t> node_receives_;
  std::vector<Warning>& warnings_;
  TextureLibrary textures_;
  ImportedScene result_;
  std::map<std::tuple<std::size_t, std::size_t, std::vector<double>>, PrimitiveGeometry> geometries_;
  std::map<int, std::uint32_t> material_of_source_;
  std::map<std::uint32_t, std::uint32_t> source_of_light_;
  std::map<std::pair<std::uint32_t, bool>, std::uint32_t> surface_of_material_;
  std::vector<std::uint32_t> material_of_surface_;
  std::vector<std::uint8_t> surface_has_colors_;
  std::vector<std::vector<glm::vec2>> texcoords_;
  std::optional<float> unit_factor_;
  Found bad_normals_, skipped_primitives_;
  bool moves_ = false;
};

}  // namespace

Result<ImportedScene> import_scene(const Document& document, const Options& options, std::vector<Warning>& warnings) {
  const auto model = typed_view(document);
  if (!model) return model.error();
  return SceneImporter(document, **model, options, warnings).run();
}

Result<ImportedScene> import_displayed(const Document& document, std::optional<std::uint32_t> scene,
                                       std::vector<Warning>& warnings) {
  const auto model = typed_view(document);
  if (!model) return model.error();
  Options options;
  options.scene = scene;
  return SceneImporter(document, **model, options, warnings).run_without_light();
}

}  // namespace gltf_radiosity
