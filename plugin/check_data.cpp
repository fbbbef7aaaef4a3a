// Checks of what meshes are made of: buffers, bufferViews, accessors, primitives.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "plugin/accessor_view.h"
#include "plugin/check_document.h"

namespace gltf_radiosity {
namespace {

/// Accessors without data cost nothing in the file; no more than this can be told apart by indices.
constexpr std::uint64_t kMaxEmptyCount = std::uint64_t{1} << 32;

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

class DataChecker : private JsonChecker {
 public:
  using JsonChecker::JsonChecker;

  Result<Done> run() {
    check_buffers();
    check_accessors();
    check_meshes();
    return result();
  }

 private:
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
};

}  // namespace

Result<Done> check_data(const Json& root) { return DataChecker(root).run(); }

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

}  // namespace gltf_radiosity
