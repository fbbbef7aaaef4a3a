#include "plugin/drop_unused.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "plugin/check_document.h"
#include "plugin/draco_codec.h"

namespace gltf_radiosity {
namespace {

using Visit = std::function<void(Json&)>;

/// Beginnings of names of extensions that refer to neither accessors nor bufferViews, or where this file looks.
constexpr std::array<std::string_view, 17> kKnown = {
    "KHR_materials_", "EXT_materials_",        "ADOBE_materials_", "KHR_texture_", "EXT_texture_",
    "MSFT_texture_",  "MSFT_packing_",         "KHR_lights_",      "EXT_lights_",  "KHR_xmp",
    "MSFT_lod",       "KHR_mesh_quantization", "KHR_draco_",       "EXT_meshopt_", "KHR_animation_",
    "EXT_mesh_gpu_",  "KHR_node_visibility"};

bool is_known(std::string_view extension) {
  return std::any_of(kKnown.begin(), kKnown.end(),
                     [&](std::string_view begin) { return extension.starts_with(begin); });
}

void visit_member(Json& object, const char* key, const Visit& visit) {
  if (object.is_object() && object.contains(key)) visit(object[key]);
}

void visit_members(Json& object, const char* key, const Visit& visit) {
  if (!object.is_object() || !object.contains(key)) return;
  for (Json& member : object[key]) visit(member);
}

Json* known_extension(Json& object, const char* name) {
  const bool has_it = object.is_object() && object.contains("extensions") && object["extensions"].contains(name);
  return has_it ? &object["extensions"][name] : nullptr;
}

/// Calls `visit` for every number of an accessor in the tree.
void visit_accessor_numbers(Json& root, const Visit& visit) {
  visit_members(root, "meshes", [&](Json& mesh) {
    visit_members(mesh, "primitives", [&](Json& primitive) {
      visit_member(primitive, "indices", visit);
      visit_members(primitive, "attributes", visit);
      visit_members(primitive, "targets", [&](Json& target) {
        for (Json& accessor : target) visit(accessor);
      });
    });
  });
  visit_members(root, "skins", [&](Json& skin) { visit_member(skin, "inverseBindMatrices", visit); });
  visit_members(root, "animations", [&](Json& animation) {
    visit_members(animation, "samplers", [&](Json& sampler) {
      visit_member(sampler, "input", visit);
      visit_member(sampler, "output", visit);
    });
  });
  visit_members(root, "nodes", [&](Json& node) {
    if (Json* instances = known_extension(node, "EXT_mesh_gpu_instancing"))
      visit_members(*instances, "attributes", visit);
  });
}

/// Calls `visit` for every number of a bufferView in the tree.
void visit_view_numbers(Json& root, const Visit& visit) {
  visit_members(root, "accessors", [&](Json& accessor) {
    visit_member(accessor, "bufferView", visit);
    if (!accessor.contains("sparse")) return;
    visit_member(accessor["sparse"]["indices"], "bufferView", visit);
    visit_member(accessor["sparse"]["values"], "bufferView", visit);
  });
  visit_members(root, "images", [&](Json& image) { visit_member(image, "bufferView", visit); });
  visit_members(root, "meshes", [&](Json& mesh) {
    visit_members(mesh, "primitives", [&](Json& primitive) {
      if (Json* draco = known_extension(primitive, kDracoExtension)) visit_member(*draco, "bufferView", visit);
    });
  });
}

/// Calls `visit` for every number of an image in the tree.
void visit_image_numbers(Json& root, const Visit& visit) {
  visit_members(root, "textures", [&](Json& texture) {
    visit_member(texture, "source", visit);
    visit_members(texture, "extensions", [&](Json& extension) { visit_member(extension, "source", visit); });
  });
  if (Json* lights = known_extension(root, "EXT_lights_image_based")) {
    visit_members(*lights, "lights", [&](Json& light) {
      visit_members(light, "specularImages", [&](Json& level) {
        for (Json& image : level) visit(image);
      });
    });
  }
}

void collect_numbers(const Json& value, std::vector<std::size_t>& numbers) {
  if (const auto number = whole_number(value)) numbers.push_back(*number);
  if (!value.is_structured()) return;
  for (const Json& member : value) collect_numbers(member, numbers);
}

/// Whole numbers in extensions that may mean anything.
void collect_unknown_numbers(const Json& value, std::vector<std::size_t>& numbers) {
  if (!value.is_structured()) return;
  for (const auto& item : value.items()) {
    if (value.is_object() && item.key() == "extensions" && item.value().is_object()) {
      for (const auto& extension : item.value().items()) {
        if (!is_known(extension.key())) collect_numbers(extension.value(), numbers);
      }
    }
    collect_unknown_numbers(item.value(), numbers);
  }
}

using VisitNumbers = std::function<void(Json&, const Visit&)>;

/// Calls `act(json, number)` for every number below `count` that `visit_numbers` finds. Anything else refers to
/// nothing: what a vendor's extension calls "source" may be a name.
template <typename Act>
void for_each_number(Json& root, std::size_t count, const VisitNumbers& visit_numbers, const Act& act) {
  visit_numbers(root, [&](Json& json) {
    if (const auto number = whole_number(json); number && *number < count) act(json, static_cast<std::size_t>(*number));
  });
}

/// Which of `count` elements are needed: those that `visit_numbers` finds, and those that `unknown` numbers may mean.
std::vector<std::uint8_t> used_elements(Json& root, std::size_t count, const std::vector<std::size_t>& unknown,
                                        const VisitNumbers& visit_numbers) {
  std::vector<std::uint8_t> used(count, 0);
  for (const std::size_t number : unknown) {
    if (number < used.size()) used[number] = 1;
  }
  for_each_number(root, count, visit_numbers, [&](const Json&, std::size_t number) { used[number] = 1; });
  return used;
}

/// Keeps the elements of root[array] that `stays` says, [its size], and gives all that refers to them their new
/// numbers.
void renumber(Json& root, const char* array, const std::vector<std::uint8_t>& stays,
              const VisitNumbers& visit_numbers) {
  std::vector<std::size_t> number_of(stays.size(), 0);
  Json kept = Json::array();
  for (std::size_t i = 0; i < stays.size(); ++i) {
    number_of[i] = kept.size();
    if (stays[i] != 0) kept.push_back(std::move(root[array][i]));
  }
  for_each_number(root, number_of.size(), visit_numbers,
                  [&](Json& json, std::size_t number) { json = number_of[number]; });
  if (kept.empty()) {
    root.erase(array);
  } else {
    root[array] = std::move(kept);
  }
}

/// Removes the elements of root[array] that nothing refers to; where `unknown` numbers may mean some, makes stubs of
/// the others.
void keep_used(Json& root, const char* array, const std::vector<std::size_t>& unknown, const Json& stub,
               const VisitNumbers& visit_numbers) {
  if (!root.contains(array)) return;
  const std::vector<std::uint8_t> used = used_elements(root, root[array].size(), unknown, visit_numbers);
  if (unknown.empty()) return renumber(root, array, used, visit_numbers);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] == 0) root[array][i] = stub;
  }
}

/// A part of a buffer, and where it goes.
struct Part {
  std::size_t begin = 0, end = 0, new_begin = 0;
};

/// The parts of a buffer that bufferViews cover, without overlaps, ascending.
std::vector<Part> covered_parts(const Json& root, std::size_t buffer) {
  std::vector<Part> parts;
  for (const Json& view : array_of(root, "bufferViews")) {
    if (view["buffer"] != buffer) continue;
    const auto begin = view.value("byteOffset", std::size_t{0});
    parts.push_back({begin, begin + view["byteLength"].get<std::size_t>(), 0});
  }
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.begin < b.begin; });
  std::vector<Part> merged;
  for (const Part& part : parts) {
    if (!merged.empty() && part.begin <= merged.back().end) {
      merged.back().end = std::max(merged.back().end, part.end);
    } else {
      merged.push_back(part);
    }
  }
  return merged;
}

/// Whether an extension of a bufferView points into the buffer as well.
bool is_named_by_extension(const Json& root, std::size_t buffer) {
  for (const Json& view : array_of(root, "bufferViews")) {
    if (!view.contains("extensions")) continue;
    for (const Json& extension : view["extensions"]) {
      if (extension.is_object() && extension.contains("buffer") && extension["buffer"] == buffer) return true;
    }
  }
  return false;
}

/// Leaves out what nobody looks at; every part keeps its alignment to 4 bytes.
void compact_buffer(Document& document, std::size_t buffer) {
  // Bytes.
  Json& root = document.json;
  std::vector<Part> parts = covered_parts(root, buffer);
  Bytes bytes;
  for (Part& part : parts) {
    part.new_begin = (bytes.size() + 3) / 4 * 4 + part.begin % 4;
    bytes.resize(part.new_begin + part.end - part.begin);
    const auto source = std::span(document.buffers[buffer]).subspan(part.begin, part.end - part.begin);
    std::copy(source.begin(), source.end(), bytes.begin() + static_cast<std::ptrdiff_t>(part.new_begin));
  }
  document.buffers[buffer] = std::move(bytes);
  root["buffers"][buffer]["byteLength"] = document.buffers[buffer].size();

  // Views.
  if (!root.contains("bufferViews")) return;
  for (Json& view : root["bufferViews"]) {
    if (view["buffer"] != buffer) continue;
    const auto begin = view.value("byteOffset", std::size_t{0});
    const auto after = std::upper_bound(parts.begin(), parts.end(), begin,
                                        [](std::size_t at, const Part& part) { return at < part.begin; });
    const Part& part = *(after - 1);
    view["byteOffset"] = part.new_begin + begin - part.begin;
  }
}

void compact_buffers(Document& document) {
  for (std::size_t i = 0; i < document.buffers.size(); ++i) {
    if (!is_named_by_extension(document.json, i)) compact_buffer(document, i);
  }
}

}  // namespace

void drop_images(Document& document, const std::vector<std::size_t>& candidates) {
  // Images.
  Json& root = document.json;
  std::vector<std::size_t> unknown;
  collect_unknown_numbers(root, unknown);
  if (candidates.empty() || !unknown.empty()) return;
  std::vector<std::uint8_t> stays(root["images"].size(), 1);
  for (const std::size_t candidate : candidates) stays[candidate] = 0;
  for_each_number(root, stays.size(), visit_image_numbers, [&](const Json&, std::size_t image) { stays[image] = 1; });
  std::vector<std::size_t> views;
  for (std::size_t i = 0; i < stays.size(); ++i) {
    const Json& image = root["images"][i];
    if (stays[i] == 0 && image.contains("bufferView")) views.push_back(image["bufferView"].get<std::size_t>());
  }
  renumber(root, "images", stays, visit_image_numbers);

  // Their data.
  if (views.empty()) return;
  std::vector<std::uint8_t> view_stays(root["bufferViews"].size(), 1);
  for (const std::size_t view : views) view_stays[view] = 0;
  for_each_number(root, view_stays.size(), visit_view_numbers,
                  [&](const Json&, std::size_t view) { view_stays[view] = 1; });
  renumber(root, "bufferViews", view_stays, visit_view_numbers);
  compact_buffers(document);
}

void drop_unused_data(Document& document) {
  Json& root = document.json;
  std::vector<std::size_t> unknown;
  collect_unknown_numbers(root, unknown);
  keep_used(root, "accessors", unknown, {{"componentType", 5121}, {"count", 1}, {"type", "SCALAR"}},
            visit_accessor_numbers);
  keep_used(root, "bufferViews", unknown, {{"buffer", document.buffers.size()}, {"byteLength", 1}}, visit_view_numbers);
  compact_buffers(document);
}

}  // namespace gltf_radiosity
