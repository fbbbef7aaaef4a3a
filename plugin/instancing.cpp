#include "plugin/instancing.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "plugin/accessor_view.h"
#include "plugin/check_document.h"
#include "plugin/import_nodes.h"
#include "plugin/used_extensions.h"

namespace gltf_radiosity {
namespace {

constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
constexpr const char* kAnimationPointer = "KHR_animation_pointer";

/// One attribute of all copies.
struct CopyAttribute {
  std::vector<double> values;  ///< [count * width]
  std::size_t width = 1;

  Json of(std::size_t copy) const {
    if (width == 1) return values[copy];
    return Json(std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(copy * width),
                                    values.begin() + static_cast<std::ptrdiff_t>((copy + 1) * width)));
  }
};

CopyAttribute read_attribute(const Document& document, const Json& accessor) {
  const RawAccessor raw = read_accessor(document, accessor.get<std::size_t>());
  CopyAttribute attribute;
  attribute.width = static_cast<std::size_t>(raw.components);
  if (raw.component == ComponentType::kU32) {
    const std::vector<std::uint32_t> values = as_indices(raw);
    attribute.values.assign(values.begin(), values.end());
  } else {
    const std::vector<float> values = as_floats(raw);
    attribute.values.assign(values.begin(), values.end());
  }
  return attribute;
}

/// The attributes of a node's copies by name.
std::map<std::string, CopyAttribute> read_attributes(const Document& document, std::size_t node) {
  std::map<std::string, CopyAttribute> attributes;
  for (const auto& [name, accessor] : (*instancing_of(document, node))["attributes"].items()) {
    attributes[name] = read_attribute(document, accessor);
  }
  // Unit quaternions, which normalised integers are not quite.
  if (const auto found = attributes.find("ROTATION"); found != attributes.end()) {
    std::vector<double>& v = found->second.values;
    for (std::size_t i = 0; i + 3 < v.size(); i += 4) {
      const glm::dquat rotation = unit_rotation(glm::dquat(v[i + 3], v[i], v[i + 1], v[i + 2]));
      v[i] = rotation.x;
      v[i + 1] = rotation.y;
      v[i + 2] = rotation.z;
      v[i + 3] = rotation.w;
    }
  }
  return attributes;
}

std::size_t copy_count(const std::map<std::string, CopyAttribute>& attributes) {
  const auto& [values, width] = attributes.begin()->second;
  return values.size() / width;
}

/// Turns one node into a parent of its copies.
class CopyExpander {
 public:
  CopyExpander(Document& document, std::size_t node)
      : root_(document.json),
        node_(node),
        attributes_(read_attributes(document, node)),
        count_(copy_count(attributes_)) {}

  /// Returns the node of the first copy; the others follow it.
  std::size_t run() {
    const std::size_t first = root_["nodes"].size();
    for (std::size_t copy = 0; copy < count_; ++copy) root_["nodes"].push_back(node_of(copy));
    Json& node = root_["nodes"][node_];
    for (std::size_t copy = 0; copy < count_; ++copy) node["children"].push_back(first + copy);
    for (const char* key : {"mesh", "weights"}) node.erase(key);
    remove_extension(node, kInstancing);
    if (root_.contains("animations")) {
      for (Json& animation : root_["animations"]) retarget(animation, first);
    }
    return first;
  }

 private:
  Json node_of(std::size_t copy) const {
    const Json& node = root_["nodes"][node_];
    Json result;
    if (node.contains("name")) result["name"] = fmt::format("{}[{}]", node["name"].get<std::string>(), copy);
    for (const char* key : {"mesh", "weights"}) {
      if (node.contains(key)) result[key] = node[key];
    }
    for (const auto& [name, attribute] : attributes_) {
      if (name == "TRANSLATION") result["translation"] = attribute.of(copy);
      if (name == "ROTATION") result["rotation"] = attribute.of(copy);
      if (name == "SCALE") result["scale"] = attribute.of(copy);
      if (name.starts_with('_')) result["extras"][name] = attribute.of(copy);
    }
    return result;
  }

  /// Whoever animates the node's morph weights animates those of its copies. (Nobody has checked the animations.)
  void retarget(Json& animation, std::size_t first) const {
    if (!animation.contains("channels") || !animation["channels"].is_array()) return;
    Json& channels = animation["channels"];
    const std::size_t channel_count = channels.size();
    for (std::size_t i = 0; i < channel_count; ++i) {
      const std::optional<std::string> tail = animated_weights(channels[i]);
      if (!tail) continue;
      const Json channel = channels[i];
      for (std::size_t copy = 0; copy < count_; ++copy) {
        Json& own = copy == 0 ? channels[i] : channels.emplace_back(channel);
        Json& target = own["target"];
        if (target.contains("node")) target["node"] = first + copy;
        if (extension_of(target, kAnimationPointer) == nullptr) continue;
        target["extensions"][kAnimationPointer]["pointer"] = fmt::format("/nodes/{}/weights{}", first + copy, *tail);
      }
    }
  }

  /// None if `channel` does not animate the node's morph weights; else what a pointer to them says after "weights".
  std::optional<std::string> animated_weights(const Json& channel) const {
    if (!channel.is_object() || !channel.contains("target") || !channel["target"].is_object()) return std::nullopt;
    const Json& target = channel["target"];
    const Json* pointer = extension_of(target, kAnimationPointer);
    if (pointer == nullptr) {
      const bool weights = target.contains("path") && target["path"] == "weights" && target.contains("node");
      return weights && target["node"] == node_ ? std::optional<std::string>("") : std::nullopt;
    }
    const std::string start = fmt::format("/nodes/{}/weights", node_);
    if (!pointer->is_object() || !pointer->contains("pointer") || !(*pointer)["pointer"].is_string()) {
      return std::nullopt;
    }
    const auto path = (*pointer)["pointer"].get<std::string>();
    return path.starts_with(start) ? std::optional(path.substr(start.size())) : std::nullopt;
  }

  Json& root_;
  std::size_t node_;
  std::map<std::string, CopyAttribute> attributes_;
  std::size_t count_;
};

}  // namespace

const Json* instancing_of(const Document& document, std::size_t node) {
  const Json* extension = extension_of(document.json["nodes"][node], kInstancing);
  const bool any = extension != nullptr && extension->contains("attributes") && !(*extension)["attributes"].empty();
  return any ? extension : nullptr;
}

std::vector<glm::dmat4> copy_transforms(const Document& document, std::size_t node) {
  if (instancing_of(document, node) == nullptr) return {glm::dmat4(1.0)};
  const auto attributes = read_attributes(document, node);
  std::vector<glm::dmat4> transforms(copy_count(attributes), glm::dmat4(1.0));
  const auto values_of = [&attributes](const char* name) -> const double* {
    const auto found = attributes.find(name);
    return found == attributes.end() ? nullptr : found->second.values.data();
  };
  const double* translation = values_of("TRANSLATION");
  const double* rotation = values_of("ROTATION");
  const double* scale = values_of("SCALE");
  for (std::size_t i = 0; i < transforms.size(); ++i) {
    if (translation != nullptr) {
      transforms[i] =
          glm::translate(transforms[i], {translation[3 * i], translation[3 * i + 1], translation[3 * i + 2]});
    }
    if (rotation != nullptr) {
      const double* q = rotation + 4 * i;
      transforms[i] *= glm::mat4_cast(glm::dquat(q[3], q[0], q[1], q[2]));
    }
    if (scale != nullptr) transforms[i] = glm::scale(transforms[i], {scale[3 * i], scale[3 * i + 1], scale[3 * i + 2]});
  }
  return transforms;
}

std::vector<std::size_t> expand_copies(Document& document, std::span<const PrimitiveInstance> instances) {
  std::map<std::size_t, std::size_t> first_copy_of;
  for (const PrimitiveInstance& instance : instances) {
    if (!instance.receives || first_copy_of.contains(instance.node)) continue;
    if (instancing_of(document, instance.node) == nullptr) continue;
    first_copy_of[instance.node] = CopyExpander(document, instance.node).run();
  }
  std::vector<std::size_t> nodes;
  for (const PrimitiveInstance& instance : instances) {
    const auto expanded = first_copy_of.find(instance.node);
    nodes.push_back(expanded == first_copy_of.end() ? instance.node : expanded->second + instance.copy);
  }
  if (first_copy_of.empty()) return nodes;
  const Json& all = document.json["nodes"];
  const bool left =
      std::any_of(all.begin(), all.end(), [](const Json& node) { return extension_of(node, kInstancing) != nullptr; });
  if (!left) forget_extension(document.json, kInstancing);
  return nodes;
}

}  // namespace gltf_radiosity
