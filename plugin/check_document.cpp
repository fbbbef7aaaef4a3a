#include "plugin/check_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "plugin/accessor_view.h"
#include "plugin/import_textures.h"

namespace gltf_radiosity {
namespace {

/// TEXCOORD_n beyond this is a mistake.
constexpr std::uint64_t kMaxTexcoord = 63;

constexpr std::string_view kSupportedExtensions[] = {
    "KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression",  // decoded while reading
    "KHR_texture_transform", "KHR_lights_punctual", "EXT_mesh_gpu_instancing", "KHR_node_visibility",
    "KHR_mesh_quantization", "EXT_texture_webp", "EXT_lights_image_based", "KHR_texture_basisu", "EXT_texture_avif",
    "MSFT_texture_dds",  // the plain image or none: import_textures
    "KHR_materials_emissive_strength", "KHR_materials_unlit", "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_transmission", "KHR_materials_diffuse_transmission", "KHR_materials_volume",
    // These hardly change how diffuse light travels.
    "KHR_materials_anisotropy", "KHR_materials_clearcoat", "KHR_materials_dispersion", "KHR_materials_ior",
    "KHR_materials_iridescence", "KHR_materials_sheen", "KHR_materials_specular", "KHR_materials_variants",
    // These have nothing to do with light.
    "KHR_animation_pointer", "KHR_xmp", "KHR_xmp_json_ld"};

class TreeChecker : private JsonChecker {
 public:
  using JsonChecker::JsonChecker;

  Result<Done> run() {
    if (!root_.is_object()) return bad_input("", "the JSON is not an object");
    check_asset();
    check_arrays();
    check_extensions();
    if (!error_) {
      if (auto checked = check_data(root_); !checked) return checked;
    }
    check_images();
    check_materials();
    check_lights();
    check_skins();
    check_animations();
    check_nodes();
    check_forest();
    check_scenes();
    if (!error_) return check_environment(root_);
    return result();
  }

 private:
  void check_asset() {
    const Json* asset = object_in(root_, "asset", "asset");
    if (asset == nullptr) return fail("asset", "is missing: this is not a glTF 2.0");
    for (const char* key : {"version", "minVersion"}) {
      if (!asset->contains(key) && std::string_view(key) == "minVersion") continue;
      const Json version = asset->value(key, Json());
      const std::string text = version.is_string() ? version.get<std::string>() : "";
      const bool fine = std::string_view(key) == "version" ? text.starts_with("2.") : text == "2.0";
      if (!fine) fail("asset", fmt::format("{} \"{}\" is not supported, glTF 2.0 is", key, text));
    }
    string_if_present(*asset, "generator", "asset");
  }

  void check_arrays() {
    for (const char* key : {"scenes", "nodes", "meshes", "accessors", "bufferViews", "buffers", "materials", "textures",
                            "images", "samplers", "skins", "animations"}) {
      const Json& elements = array_in(root_, key, "");
      for (std::size_t i = 0; i < elements.size() && !error_; ++i) {
        const std::string place = place_of(key, i);
        if (!elements[i].is_object()) return fail(place, "is not an object");
        string_if_present(elements[i], "name", place);
        const Json* extensions = object_in(elements[i], "extensions", place);
        if (extensions == nullptr) continue;
        for (const auto& [name, value] : extensions->items()) {
          if (!value.is_object()) fail(place, fmt::format("extension \"{}\" is not an object", name));
        }
      }
    }
    object_in(root_, "extensions", "");
  }

  void check_extensions() {
    for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
      for (const Json& name : array_in(root_, key, "")) {
        if (!name.is_string()) fail(key, "holds something that is not a string");
      }
    }
    for (const Json& name : array_of(root_, "extensionsRequired")) {
      if (error_) return;
      const auto text = name.get<std::string>();
      if (std::find(std::begin(kSupportedExtensions), std::end(kSupportedExtensions), text) ==
          std::end(kSupportedExtensions)) {
        fail("extensionsRequired", fmt::format("{} is not supported", text));
      }
    }
  }

  void check_images() {
    for (std::size_t i = 0; i < size("images") && !error_; ++i) {
      const std::string place = place_of("images", i);
      const Json& image = root_["images"][i];
      index(image, "bufferView", "bufferViews", place);
      string_if_present(image, "uri", place);
      string_if_present(image, "mimeType", place);
      if (!image.contains("uri") && !image.contains("bufferView")) fail(place, "has neither a uri nor a bufferView");
    }
    for (std::size_t i = 0; i < size("samplers") && !error_; ++i) {
      number(root_["samplers"][i], "wrapS", 10497, place_of("samplers", i));
      number(root_["samplers"][i], "wrapT", 10497, place_of("samplers", i));
    }
    for (std::size_t i = 0; i < size("textures") && !error_; ++i) {
      const std::string place = place_of("textures", i);
      const Json& texture = root_["textures"][i];
      index(texture, "source", "images", place);
      index(texture, "sampler", "samplers", place);
      for (const char* name : kImageExtensions) {
        if (const Json* extension = extension_of(texture, name)) index(*extension, "source", "images", place, true);
      }
    }
  }

  void check_texture_info(const Json& owner, const std::string& key, const std::string& place) {
    const Json* info = object_in(owner, key, place);
    if (info == nullptr) return;
    const std::string info_place = place + "." + key;
    index(*info, "index", "textures", info_place, true);
    if (number(*info, "texCoord", 0, info_place) > kMaxTexcoord) fail(info_place, "\"texCoord\" is out of range");
    object_in(*info, "extensions", info_place);
    if (error_) return;
    const Json* transform = extension_of(*info, "KHR_texture_transform");
    if (transform == nullptr) return;
    if (!transform->is_object()) return fail(info_place, "KHR_texture_transform is not an object");
    numbers(*transform, "offset", 2, info_place);
    numbers(*transform, "scale", 2, info_place);
    number_if_present(*transform, "rotation", info_place);
    if (number(*transform, "texCoord", 0, info_place) > kMaxTexcoord) fail(info_place, "\"texCoord\" is out of range");
  }

  void check_materials() {
    for (std::size_t i = 0; i < size("materials") && !error_; ++i) {
      const std::string place = place_of("materials", i);
      const Json& material = root_["materials"][i];
      numbers(material, "emissiveFactor", 3, place);
      check_texture_info(material, "emissiveTexture", place);
      string_if_present(material, "alphaMode", place);
      number_if_present(material, "alphaCutoff", place);
      bool_if_present(material, "doubleSided", place);
      if (const Json* pbr = object_in(material, "pbrMetallicRoughness", place)) {
        numbers(*pbr, "baseColorFactor", 4, place);
        number_if_present(*pbr, "metallicFactor", place);
        check_texture_info(*pbr, "baseColorTexture", place + ".pbrMetallicRoughness");
        check_texture_info(*pbr, "metallicRoughnessTexture", place + ".pbrMetallicRoughness");
      }
      if (error_) return;
      check_material_extensions(material, place);
    }
  }

  void check_material_extensions(const Json& material, const std::string& place) {
    if (const Json* strength = extension_of(material, "KHR_materials_emissive_strength")) {
      number_if_present(*strength, "emissiveStrength", place);
    }
    if (const Json* glossy = extension_of(material, "KHR_materials_pbrSpecularGlossiness")) {
      numbers(*glossy, "diffuseFactor", 4, place);
      numbers(*glossy, "specularFactor", 3, place);
      check_texture_info(*glossy, "diffuseTexture", place + ".KHR_materials_pbrSpecularGlossiness");
    }
    if (const Json* straight = extension_of(material, "KHR_materials_transmission")) {
      number_if_present(*straight, "transmissionFactor", place);
      check_texture_info(*straight, "transmissionTexture", place + ".KHR_materials_transmission");
    }
    if (const Json* volume = extension_of(material, "KHR_materials_volume")) {
      number_if_present(*volume, "thicknessFactor", place);
      number_if_present(*volume, "attenuationDistance", place);
      numbers(*volume, "attenuationColor", 3, place);
    }
    if (const Json* diffuse = extension_of(material, "KHR_materials_diffuse_transmission")) {
      number_if_present(*diffuse, "diffuseTransmissionFactor", place);
      numbers(*diffuse, "diffuseTransmissionColorFactor", 3, place);
      check_texture_info(*diffuse, "diffuseTransmissionTexture", place + ".KHR_materials_diffuse_transmission");
    }
  }

  void check_lights() {
    if (error_) return;
    const Json* extension = extension_of(root_, "KHR_lights_punctual");
    if (extension == nullptr) return;
    if (!extension->is_object()) return fail("extensions", "KHR_lights_punctual is not an object");
    const Json& lights = array_in(*extension, "lights", "extensions.KHR_lights_punctual");
    light_count_ = lights.size();
    for (std::size_t i = 0; i < lights.size() && !error_; ++i) {
      const std::string place = place_of("extensions.KHR_lights_punctual.lights", i);
      if (!lights[i].is_object()) return fail(place, "is not an object");
      const Json type = lights[i].value("type", Json());
      if (type != "point" && type != "spot" && type != "directional") {
        fail(place, "\"type\" is none of point, spot and directional");
      }
      string_if_present(lights[i], "name", place);
      numbers(lights[i], "color", 3, place);
      number_if_present(lights[i], "intensity", place);
      number_if_present(lights[i], "range", place);
      if (const Json* spot = object_in(lights[i], "spot", place)) {
        number_if_present(*spot, "innerConeAngle", place);
        number_if_present(*spot, "outerConeAngle", place);
      }
    }
  }

  void check_skins() {
    for (std::size_t i = 0; i < size("skins") && !error_; ++i) {
      const std::string place = place_of("skins", i);
      const Json& joints = array_in(root_["skins"][i], "joints", place);
      if (joints.empty()) return fail(place, "has no joints");
      check_indices(joints, "joints", "nodes", place);
      const auto matrices = index(root_["skins"][i], "inverseBindMatrices", "accessors", place);
      if (!matrices) continue;
      const Json& accessor = root_["accessors"][*matrices];
      if (accessor["type"] != "MAT4" || number(accessor, "count", std::nullopt, place) < joints.size()) {
        fail(place, "inverseBindMatrices are not one MAT4 for each joint");
      }
    }
  }

  void check_animations() {
    for (std::size_t i = 0; i < size("animations") && !error_; ++i) {
      const std::string place = place_of("animations", i);
      for (const Json& sampler : array_in(root_["animations"][i], "samplers", place)) {
        if (!sampler.is_object()) return fail(place, "a sampler is not an object");
        index(sampler, "input", "accessors", place);
        index(sampler, "output", "accessors", place);
      }
    }
  }

  void check_indices(const Json& indices, const std::string& key, const char* array, const std::string& place) {
    for (const Json& value : indices) {
      const auto index = whole_number(value);
      const bool fine = index && *index < size(array);
      if (!fine)
        fail(place, fmt::format("\"{}\" refers to {}[{}], but there are {}", key, array, value.dump(-1, ' ', true),
                                size(array)));
    }
  }

  void check_nodes() {
    for (std::size_t i = 0; i < size("nodes") && !error_; ++i) {
      const std::string place = place_of("nodes", i);
      const Json& node = root_["nodes"][i];
      index(node, "mesh", "meshes", place);
      index(node, "skin", "skins", place);
      numbers(node, "matrix", 16, place);
      numbers(node, "translation", 3, place);
      numbers(node, "rotation", 4, place);
      numbers(node, "scale", 3, place);
      check_indices(array_in(node, "children", place), "children", "nodes", place);
      check_weights(node, place);
      if (error_) return;
      if (const Json* visibility = extension_of(node, "KHR_node_visibility")) {
        bool_if_present(*visibility, "visible", place);
      }
      if (const Json* instancing = extension_of(node, "EXT_mesh_gpu_instancing")) check_instancing(*instancing, place);
      const Json* light = extension_of(node, "KHR_lights_punctual");
      if (light == nullptr) continue;
      const std::uint64_t light_index = number(*light, "light", std::nullopt, place);
      if (light_index >= light_count_)
        fail(place, fmt::format("refers to light {}, but there are {}", light_index, light_count_));
    }
  }

  void check_instancing(const Json& instancing, const std::string& place) {
    const Json* attributes = object_in(instancing, "attributes", place);
    if (attributes == nullptr) return;
    std::optional<Json> count;
    for (const auto& [name, value] : attributes->items()) {
      const auto accessor = index(*attributes, name, "accessors", place);
      if (!accessor) return;
      const Json& json = root_["accessors"][*accessor];
      const bool vector = name == "TRANSLATION" || name == "SCALE";
      if ((vector && json["type"] != "VEC3") || (name == "ROTATION" && json["type"] != "VEC4")) {
        return fail(place, fmt::format("{} of its instances cannot be {}", name, json["type"].get<std::string>()));
      }
      if (!json.contains("bufferView") && !json.contains("sparse")) {
        return fail(place, fmt::format("{} of its instances has no data", name));
      }
      if (!count) count = json["count"];
      if (json["count"] != *count) return fail(place, "the attributes of its instances have different counts");
    }
  }

  /// Every node has at most one parent, and following parents ends.
  void check_forest() {
    if (error_) return;
    const std::size_t count = size("nodes");
    std::vector<std::size_t> parent(count, count);
    for (std::size_t i = 0; i < count; ++i) {
      for (const Json& value : array_of(root_["nodes"][i], "children")) {
        const auto child = value.get<std::size_t>();
        if (parent[child] == i) return fail(place_of("nodes", i), fmt::format("has nodes[{}] as a child twice", child));
        if (parent[child] != count) {
          return fail(place_of("nodes", child),
                      fmt::format("is a child of nodes[{}] and of nodes[{}]", parent[child], i));
        }
        parent[child] = i;
      }
    }
    // Walk up from each node, stopping where an earlier walk has been: linear in all.
    std::vector<std::size_t> seen_by(count, count);
    for (std::size_t i = 0; i < count; ++i) {
      std::size_t node = i;
      for (; node != count && seen_by[node] == count; node = parent[node]) seen_by[node] = i;
      if (node != count && seen_by[node] == i) return fail(place_of("nodes", node), "is its own ancestor");
    }
  }

  void check_scenes() {
    index(root_, "scene", "scenes", "scene");
    for (std::size_t i = 0; i < size("scenes") && !error_; ++i) {
      const std::string place = place_of("scenes", i);
      check_indices(array_in(root_["scenes"][i], "nodes", place), "nodes", "nodes", place);
    }
  }

  std::size_t light_count_ = 0;
};

}  // namespace

Result<Done> check_structure(const Json& root) { return TreeChecker(root).run(); }

}  // namespace gltf_radiosity
