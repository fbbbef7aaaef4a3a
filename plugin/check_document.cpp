#include "plugin/check_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "plugin/accessor_view.h"

namespace gltf_radiosity {
namespace {

/// No file this project can bake comes near it, and nothing below it overflows 64 bits when multiplied by a stride.
constexpr std::uint64_t kMaxCount = std::uint64_t{1} << 40;
/// Accessors without data cost nothing in the file but memory here: 2^24 elements are enough.
constexpr std::uint64_t kMaxEmptyCount = std::uint64_t{1} << 24;
/// TEXCOORD_n beyond this is a mistake.
constexpr std::uint64_t kMaxTexcoord = 63;

constexpr std::string_view kSupportedExtensions[] = {
    "KHR_draco_mesh_compression", "KHR_texture_transform", "KHR_lights_punctual", "KHR_mesh_quantization",
    "EXT_texture_webp",
    "KHR_texture_basisu",  // textures without a plain image: import_textures
    "KHR_materials_emissive_strength", "KHR_materials_unlit",
    "KHR_materials_pbrSpecularGlossiness",  // import_materials warns
    // These hardly change how diffuse light travels.
    "KHR_materials_anisotropy", "KHR_materials_clearcoat", "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion", "KHR_materials_ior", "KHR_materials_iridescence", "KHR_materials_sheen",
    "KHR_materials_specular", "KHR_materials_transmission", "KHR_materials_variants", "KHR_materials_volume",
    // These have nothing to do with light.
    "KHR_animation_pointer", "KHR_xmp", "KHR_xmp_json_ld"};

struct AttributeRule {
  std::string_view name;        ///< a set number may follow
  std::string_view types;       ///< allowed accessor types
  std::string_view components;  ///< allowed component types, KHR_mesh_quantization included: a letter each
};
constexpr AttributeRule kAttributeRules[] = {{"POSITION", "VEC3", "bBsSf"},  {"NORMAL", "VEC3", "bsf"},
                                             {"TANGENT", "VEC4", "bsf"},     {"TEXCOORD_", "VEC2", "bBsSf"},
                                             {"COLOR_", "VEC3 VEC4", "BSf"}, {"JOINTS_", "VEC4", "BS"},
                                             {"WEIGHTS_", "VEC4", "BSf"}};

char letter_of(std::uint64_t component_type) {
  constexpr std::string_view kLetters = "bBsS?If";
  return component_type >= 5120 && component_type <= 5126 ? kLetters[component_type - 5120] : '?';
}

/// Walks the tree. The first error sticks: every check after it does nothing and answers a harmless default.
class Checker {
 public:
  explicit Checker(const Json& root) : root_(root) {}

  Result<Done> run() {
    if (!root_.is_object()) return bad_input("", "the JSON is not an object");
    check_asset();
    check_arrays();
    check_extensions();
    check_buffers();
    check_accessors();
    check_images();
    check_materials();
    check_lights();
    check_meshes();
    check_skins();
    check_nodes();
    check_forest();
    check_scenes();
    if (error_) return *error_;
    return Done{};
  }

 private:
  // What checks are made of.
  void fail(std::string place, std::string message) {
    if (!error_) error_ = bad_input(std::move(place), std::move(message));
  }

  std::size_t size(const char* array) const { return array_of(root_, array).size(); }

  const Json* object_in(const Json& object, const std::string& key, const std::string& place) {
    const auto it = object.find(key);
    if (it == object.end()) return nullptr;
    if (it->is_object()) return &*it;
    fail(place, fmt::format("\"{}\" is not an object", key));
    return nullptr;
  }

  const Json& array_in(const Json& object, const std::string& key, const std::string& place) {
    const auto it = object.find(key);
    if (it != object.end() && !it->is_array()) fail(place, fmt::format("\"{}\" is not an array", key));
    return array_of(object, key);
  }

  std::uint64_t number(const Json& object, const std::string& key, std::optional<std::uint64_t> fallback,
                       const std::string& place) {
    if (!object.contains(key)) {
      if (!fallback) fail(place, fmt::format("\"{}\" is missing", key));
      return fallback.value_or(0);
    }
    const auto value = whole_number(object.at(key));
    if (!value || *value > kMaxCount) fail(place, fmt::format("\"{}\" is not a whole number in range", key));
    return value.value_or(0);
  }

  /// An index into root[array]; none if missing or wrong.
  std::optional<std::uint64_t> index(const Json& object, const std::string& key, const char* array,
                                     const std::string& place, bool required = false) {
    if (!required && !object.contains(key)) return std::nullopt;
    const std::uint64_t value = number(object, key, std::nullopt, place);
    if (value >= size(array)) {
      fail(place, fmt::format("\"{}\" refers to {}[{}], but there are {}", key, array, value, size(array)));
    }
    return error_ ? std::nullopt : std::optional(value);
  }

  void numbers(const Json& object, const std::string& key, std::size_t count, const std::string& place) {
    const Json& values = array_in(object, key, place);
    if (!object.contains(key)) return;
    const bool fine = values.size() == count && std::all_of(values.begin(), values.end(), [](const Json& value) {
                        return value.is_number() && std::isfinite(value.get<float>());
                      });
    if (!fine) fail(place, fmt::format("\"{}\" is not {} finite numbers", key, count));
  }

  void number_if_present(const Json& object, const std::string& key, const std::string& place) {
    const auto it = object.find(key);
    if (it == object.end() || (it->is_number() && std::isfinite(it->get<float>()))) return;
    fail(place, fmt::format("\"{}\" is not a finite number", key));
  }

  void string_if_present(const Json& object, const std::string& key, const std::string& place) {
    const auto it = object.find(key);
    if (it != object.end() && !it->is_string()) fail(place, fmt::format("\"{}\" is not a string", key));
  }

  void bool_if_present(const Json& object, const std::string& key, const std::string& place) {
    const auto it = object.find(key);
    if (it != object.end() && !it->is_boolean()) fail(place, fmt::format("\"{}\" is neither true nor false", key));
  }

  // The parts of a glTF.
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
    for (std::size_t i = 0; i < size("bufferViews"); ++i) {
      if (extension_of(root_["bufferViews"][i], "EXT_meshopt_compression") != nullptr) {
        fail(place_of("bufferViews", i), "EXT_meshopt_compression is not supported yet");
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

  void check_buffers() {
    for (std::size_t i = 0; i < size("buffers") && !error_; ++i) {
      const std::string place = place_of("buffers", i);
      number(root_["buffers"][i], "byteLength", std::nullopt, place);
      string_if_present(root_["buffers"][i], "uri", place);
    }
    for (std::size_t i = 0; i < size("bufferViews") && !error_; ++i) {
      const std::string place = place_of("bufferViews", i);
      const Json& view = root_["bufferViews"][i];
      const auto buffer = index(view, "buffer", "buffers", place, true);
      const std::uint64_t end = number(view, "byteOffset", 0, place) + number(view, "byteLength", std::nullopt, place);
      number(view, "byteStride", 0, place);
      if (!buffer) return;
      const std::uint64_t length = number(root_["buffers"][*buffer], "byteLength", std::nullopt, place);
      if (end > length) fail(place, fmt::format("reaches {} bytes beyond buffers[{}]", end - length, *buffer));
    }
  }

  /// `count` elements of `size` bytes from `reference.byteOffset` on fit into `reference.bufferView`.
  void check_extent(const Json& reference, std::uint64_t count, std::uint64_t element_size, bool strided,
                    const std::string& place) {
    const auto view_index = index(reference, "bufferView", "bufferViews", place, true);
    const std::uint64_t offset = number(reference, "byteOffset", 0, place);
    if (error_ || count == 0) return;
    const Json& view = root_["bufferViews"][*view_index];
    std::uint64_t stride = strided ? number(view, "byteStride", 0, place) : 0;
    if (stride == 0) stride = element_size;
    if (stride < element_size)
      fail(place, fmt::format("elements overlap: bufferViews[{}].byteStride is {}", *view_index, stride));
    if (stride > 65536)
      return fail(place_of("bufferViews", *view_index), "\"byteStride\" is not a whole number in range");
    const std::uint64_t length = number(view, "byteLength", std::nullopt, place);
    // count <= 2^40 and stride <= 2^16, so nothing overflows.
    const std::uint64_t end = offset + stride * (count - 1) + element_size;
    if (end > length) fail(place, fmt::format("reads {} bytes beyond bufferViews[{}]", end - length, *view_index));
  }

  void check_accessors() {
    for (std::size_t i = 0; i < size("accessors") && !error_; ++i) {
      const std::string place = place_of("accessors", i);
      const Json& accessor = root_["accessors"][i];
      const std::uint64_t count = number(accessor, "count", std::nullopt, place);
      const std::uint64_t component = number(accessor, "componentType", std::nullopt, place);
      string_if_present(accessor, "type", place);
      bool_if_present(accessor, "normalized", place);
      if (error_) return;
      const auto layout = element_layout(accessor.value("type", ""), component);
      if (!layout)
        return fail(place, fmt::format("type \"{}\" of component type {} does not exist", accessor.value("type", ""),
                                       component));

      if (accessor.contains("bufferView")) {
        check_extent(accessor, count, layout->size, true, place);
      } else if (count > kMaxEmptyCount) {
        fail(place, fmt::format("has {} elements but no bufferView", count));
      }
      if (const Json* sparse = object_in(accessor, "sparse", place)) check_sparse(*sparse, count, layout->size, place);
    }
  }

  void check_sparse(const Json& sparse, std::uint64_t accessor_count, std::uint64_t element_size,
                    const std::string& place) {
    const std::uint64_t count = number(sparse, "count", std::nullopt, place);
    if (count > accessor_count) fail(place, fmt::format("replaces {} of {} elements", count, accessor_count));
    const Json* indices = object_in(sparse, "indices", place);
    const Json* values = object_in(sparse, "values", place);
    if (indices == nullptr || values == nullptr) return fail(place, "\"sparse\" lacks indices or values");
    const std::uint64_t type = number(*indices, "componentType", std::nullopt, place);
    if (type != 5121 && type != 5123 && type != 5125) return fail(place, "sparse indices are not unsigned integers");
    check_extent(*indices, count, component_size(static_cast<ComponentType>(type)), false, place + ".sparse.indices");
    check_extent(*values, count, element_size, false, place + ".sparse.values");
  }

  void check_images() {
    for (std::size_t i = 0; i < size("images") && !error_; ++i) {
      const std::string place = place_of("images", i);
      const Json& image = root_["images"][i];
      index(image, "bufferView", "bufferViews", place);
      string_if_present(image, "uri", place);
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
      for (const char* name : {"EXT_texture_webp", "KHR_texture_basisu"}) {
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
      const Json* strength = extension_of(material, "KHR_materials_emissive_strength");
      if (strength != nullptr) number_if_present(*strength, "emissiveStrength", place);
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
      numbers(lights[i], "color", 3, place);
      number_if_present(lights[i], "intensity", place);
      number_if_present(lights[i], "range", place);
      if (const Json* spot = object_in(lights[i], "spot", place)) {
        number_if_present(*spot, "innerConeAngle", place);
        number_if_present(*spot, "outerConeAngle", place);
      }
    }
  }

  void check_meshes() {
    for (std::size_t i = 0; i < size("meshes") && !error_; ++i) {
      const Json& primitives = array_in(root_["meshes"][i], "primitives", place_of("meshes", i));
      check_weights(root_["meshes"][i], place_of("meshes", i));
      for (std::size_t j = 0; j < primitives.size() && !error_; ++j) {
        const std::string place = place_of_primitive(i, j);
        if (!primitives[j].is_object()) return fail(place, "is not an object");
        check_primitive(primitives[j], place);
      }
    }
  }

  void check_primitive(const Json& primitive, const std::string& place) {
    const Json* attributes = object_in(primitive, "attributes", place);
    if (attributes == nullptr) return fail(place, "\"attributes\" is missing");
    if (number(primitive, "mode", 4, place) > 6) fail(place, "\"mode\" is out of range");
    index(primitive, "material", "materials", place);
    object_in(primitive, "extensions", place);
    check_attributes(*attributes, place);
    check_targets(primitive, *attributes, place);
    if (error_) return;

    const Json* draco = extension_of(primitive, "KHR_draco_mesh_compression");
    if (const auto indices = index(primitive, "indices", "accessors", place)) {
      const Json& accessor = root_["accessors"][*indices];
      const std::uint64_t type = number(accessor, "componentType", std::nullopt, place);
      if (accessor["type"] != "SCALAR" || (type != 5121 && type != 5123 && type != 5125)) {
        fail(place, fmt::format("indices in accessors[{}] are not unsigned integers", *indices));
      }
      if (draco == nullptr && !accessor.contains("bufferView") && !accessor.contains("sparse")) {
        fail(place, fmt::format("indices in accessors[{}] have no data", *indices));
      }
    }
    if (draco != nullptr) check_draco(*draco, *attributes, place);
  }

  void check_attributes(const Json& attributes, const std::string& place) {
    std::optional<std::uint64_t> vertex_count;
    for (const auto& [name, value] : attributes.items()) {
      const auto accessor_index = index(attributes, name, "accessors", place);
      if (!accessor_index) return;
      const Json& accessor = root_["accessors"][*accessor_index];
      const std::uint64_t count = number(accessor, "count", std::nullopt, place);
      if (!vertex_count) vertex_count = count;
      if (count != *vertex_count) {
        fail(place, fmt::format("{} has {} elements where another attribute has {}", name, count, *vertex_count));
      }
      const auto type = accessor["type"].get<std::string>();
      const char component = letter_of(number(accessor, "componentType", std::nullopt, place));
      for (const AttributeRule& rule : kAttributeRules) {
        const bool applies = rule.name.ends_with('_') ? name.starts_with(rule.name) : name == rule.name;
        const bool fits = rule.types.find(type) != std::string_view::npos &&
                          rule.components.find(component) != std::string_view::npos;
        if (applies && !fits)
          fail(place,
               fmt::format("{} cannot be {} of component type {}", name, type, accessor["componentType"].dump()));
      }
    }
  }

  void check_targets(const Json& primitive, const Json& attributes, const std::string& place) {
    for (const Json& target : array_in(primitive, "targets", place)) {
      if (!target.is_object()) return fail(place, "a morph target is not an object");
      for (const auto& [name, value] : target.items()) {
        const auto accessor = index(target, name, "accessors", place);
        if (!accessor || !attributes.contains("POSITION")) return;
        const Json& position = root_["accessors"][attributes["POSITION"].get<std::size_t>()];
        if (root_["accessors"][*accessor]["count"] != position["count"])
          fail(place, "a morph target has another count than POSITION");
      }
    }
  }

  void check_draco(const Json& draco, const Json& attributes, const std::string& place) {
    if (!draco.is_object()) return fail(place, "KHR_draco_mesh_compression is not an object");
    index(draco, "bufferView", "bufferViews", place, true);
    const Json* ids = object_in(draco, "attributes", place);
    if (ids == nullptr) return fail(place, "KHR_draco_mesh_compression has no attributes");
    for (const auto& [name, id] : ids->items()) {
      number(*ids, name, std::nullopt, place);
      if (!attributes.contains(name))
        fail(place, fmt::format("KHR_draco_mesh_compression holds {}, which the primitive does not", name));
    }
  }

  void check_skins() {
    for (std::size_t i = 0; i < size("skins") && !error_; ++i) {
      const std::string place = place_of("skins", i);
      const Json& joints = array_in(root_["skins"][i], "joints", place);
      check_indices(joints, "joints", "nodes", place);
      const auto matrices = index(root_["skins"][i], "inverseBindMatrices", "accessors", place);
      if (!matrices) continue;
      const Json& accessor = root_["accessors"][*matrices];
      if (accessor["type"] != "MAT4" || number(accessor, "count", std::nullopt, place) < joints.size()) {
        fail(place, "inverseBindMatrices are not one MAT4 for each joint");
      }
    }
  }

  void check_weights(const Json& owner, const std::string& place) {
    for (const Json& weight : array_in(owner, "weights", place)) {
      if (!weight.is_number() || !std::isfinite(weight.get<float>())) fail(place, "\"weights\" are not finite numbers");
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
      string_if_present(node, "name", place);
      numbers(node, "matrix", 16, place);
      numbers(node, "translation", 3, place);
      numbers(node, "rotation", 4, place);
      numbers(node, "scale", 3, place);
      check_indices(array_in(node, "children", place), "children", "nodes", place);
      check_weights(node, place);
      if (error_) return;
      const Json* light = extension_of(node, "KHR_lights_punctual");
      if (light == nullptr) continue;
      const std::uint64_t light_index = number(*light, "light", std::nullopt, place);
      if (light_index >= light_count_)
        fail(place, fmt::format("refers to light {}, but there are {}", light_index, light_count_));
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

  const Json& root_;
  std::optional<Error> error_;
  std::size_t light_count_ = 0;
};

}  // namespace

Result<Done> check_structure(const Json& root) { return Checker(root).run(); }

Result<Done> check_sparse_indices(const Document& document) {
  const Json& accessors = array_of(document.json, "accessors");
  for (std::size_t i = 0; i < accessors.size(); ++i) {
    if (!accessors[i].contains("sparse")) continue;
    const Json& sparse = accessors[i]["sparse"];
    const Json& view = document.json["bufferViews"][sparse["indices"]["bufferView"].get<std::size_t>()];
    const Bytes& buffer = document.buffers[view["buffer"].get<std::size_t>()];
    const std::size_t start =
        view.value("byteOffset", std::size_t{0}) + sparse["indices"].value("byteOffset", std::size_t{0});
    const auto component = static_cast<ComponentType>(sparse["indices"]["componentType"].get<std::uint16_t>());
    RawAccessor raw{component, 1, false, sparse["count"].get<std::size_t>(), {}};
    const auto first = buffer.begin() + static_cast<std::ptrdiff_t>(start);
    raw.bytes.assign(first, first + static_cast<std::ptrdiff_t>(raw.count * component_size(component)));
    for (const std::uint32_t index : as_indices(raw)) {
      if (index < accessors[i]["count"].get<std::uint64_t>()) continue;
      return bad_input(place_of("accessors", i), fmt::format("sparse index {} is beyond {} elements", index,
                                                             accessors[i]["count"].get<std::uint64_t>()));
    }
  }
  return Done{};
}

std::optional<std::uint64_t> whole_number(const Json& value) {
  if (value.is_number_unsigned()) return value.get<std::uint64_t>();
  if (!value.is_number()) return std::nullopt;
  const double real = value.get<double>();
  if (!(real >= 0.0 && real < 9007199254740992.0) || real != std::floor(real)) return std::nullopt;
  return static_cast<std::uint64_t>(real);
}

const Json& array_of(const Json& root, const std::string& key) {
  static const Json empty = Json::array();
  const auto it = root.find(key);
  return it == root.end() || !it->is_array() ? empty : *it;
}

const Json* extension_of(const Json& object, const char* name) {
  const auto extensions = object.find("extensions");
  if (extensions == object.end() || !extensions->is_object()) return nullptr;
  const auto it = extensions->find(name);
  return it == extensions->end() ? nullptr : &*it;
}

}  // namespace gltf_radiosity
