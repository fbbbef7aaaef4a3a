#include "plugin/import_nodes.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <numeric>
#include <optional>

#include "core/mesh/subdivide_uniform.h"
#include "plugin/check_document.h"

namespace gltf_radiosity {
namespace {

constexpr int kMaxLevel = 8;

glm::dmat4 parent_from_node(const tinygltf::Node& node) {
  if (node.matrix.size() == 16) return glm::make_mat4(node.matrix.data());
  glm::dmat4 matrix(1.0);
  if (node.translation.size() == 3) matrix = glm::translate(matrix, glm::make_vec3(node.translation.data()));
  if (node.rotation.size() == 4) {
    matrix *= glm::mat4_cast(
        unit_rotation(glm::dquat(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2])));
  }
  if (node.scale.size() == 3) matrix = glm::scale(matrix, glm::make_vec3(node.scale.data()));
  return matrix;
}

/// extras.radiosity.subdivide; a warning if it is there but makes no sense.
std::optional<std::int8_t> level_in_extras(const Json& node, std::size_t index, std::vector<Warning>& warnings) {
  const Json* subdivide = member_at(node, {"extras", "radiosity", "subdivide"});
  if (subdivide == nullptr) return std::nullopt;
  const auto level = whole_number(*subdivide);
  if (level && *level <= kMaxLevel) return static_cast<std::int8_t>(*level);
  warnings.push_back(
      {"bad-subdivide", place_of("nodes", index),
       fmt::format("extras.radiosity.subdivide is not a whole number from 0 to {} and was ignored", kMaxLevel)});
  return std::nullopt;
}

std::vector<std::uint32_t> roots_of(const std::vector<int>& parent) {
  std::vector<std::uint32_t> roots;
  for (std::uint32_t i = 0; i < parent.size(); ++i) {
    if (parent[i] < 0) roots.push_back(i);
  }
  return roots;
}

/// KHR_node_visibility: whether a node takes itself and everything below out of the picture.
bool is_hidden(const Json& node) {
  const Json* visibility = extension_of(node, "KHR_node_visibility");
  return visibility != nullptr && !visibility->value("visible", true);
}

/// `roots` and everything below, parents before children, siblings in order, each node once; without those that
/// `is_left_out(node)` and what is below them.
template <typename IsLeftOut>
std::vector<std::uint32_t> depth_first(const tinygltf::Model& model, const std::vector<std::uint32_t>& roots,
                                       const IsLeftOut& is_left_out) {
  std::vector<std::uint32_t> order, stack(roots.rbegin(), roots.rend());
  std::vector<bool> seen(model.nodes.size(), false);
  while (!stack.empty()) {
    const std::uint32_t node = stack.back();
    stack.pop_back();
    if (seen[node] || is_left_out(node)) continue;
    seen[node] = true;
    order.push_back(node);
    const std::vector<int>& children = model.nodes[node].children;
    for (auto child = children.rbegin(); child != children.rend(); ++child) {
      stack.push_back(static_cast<std::uint32_t>(*child));
    }
  }
  return order;
}

}  // namespace

glm::dquat unit_rotation(const glm::dquat& rotation) {
  const double length = glm::length(rotation);
  return length > 0.0 && std::isfinite(length) ? rotation / length : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

Result<std::optional<std::size_t>> chosen_scene(const Json& root, std::optional<std::uint32_t> wanted) {
  const std::size_t count = array_of(root, "scenes").size();
  if (wanted && *wanted >= count) {
    return Error{ErrorCode::kBadOption, "--scene",
                 fmt::format("there is no scene {}: the file has {}, counted from 0", *wanted, count)};
  }
  if (count == 0) return std::optional<std::size_t>();
  return std::optional(wanted ? std::size_t{*wanted} : root.value("scene", std::size_t{0}));
}

Result<PlacedNodes> place_nodes(const Document& document, const tinygltf::Model& model, const Options& options,
                                std::vector<Warning>& warnings) {
  // Order.
  const std::size_t count = model.nodes.size();
  std::vector<int> parent(count, -1);
  for (std::size_t i = 0; i < count; ++i) {
    for (const int child : model.nodes[i].children) parent[static_cast<std::size_t>(child)] = static_cast<int>(i);
  }
  const auto scene = chosen_scene(document.json, options.scene);
  if (!scene) return scene.error();
  std::vector<std::uint32_t> roots = roots_of(parent);
  if (*scene) roots.assign(model.scenes[**scene].nodes.begin(), model.scenes[**scene].nodes.end());
  PlacedNodes placed;
  placed.visible =
      depth_first(model, roots, [&document](std::uint32_t node) { return is_hidden(document.json["nodes"][node]); });

  // Options.
  for (const auto& [name, level] : options.subdivide) {
    if (level < 0 || level > kMaxLevel) {
      return Error{ErrorCode::kBadOption, "subdivide", fmt::format("{} is not from 0 to {}", level, kMaxLevel)};
    }
    const bool known =
        std::any_of(placed.visible.begin(), placed.visible.end(),
                    [&wanted = name, &model](std::uint32_t node) { return model.nodes[node].name == wanted; });
    if (!known)
      return Error{ErrorCode::kBadOption, "subdivide", fmt::format("no node of the scene is called \"{}\"", name)};
  }

  // Transforms and levels, from the roots down.
  placed.world_from_node.assign(count, glm::dmat4(1.0));
  placed.level.assign(count, radiosity::kLevelFromPatchSize);
  for (const std::uint32_t node : depth_first(model, roots_of(parent), [](std::uint32_t) { return false; })) {
    placed.world_from_node[node] = parent_from_node(model.nodes[node]);
    std::optional<std::int8_t> level = level_in_extras(document.json["nodes"][node], node, warnings);
    for (const auto& [name, wanted] : options.subdivide) {
      if (name == model.nodes[node].name) level = static_cast<std::int8_t>(wanted);
    }
    if (level) placed.level[node] = *level;
    if (parent[node] < 0) continue;
    const auto above = static_cast<std::size_t>(parent[node]);
    placed.world_from_node[node] = placed.world_from_node[above] * placed.world_from_node[node];
    if (!level) placed.level[node] = placed.level[above];
  }
  return placed;
}

}  // namespace gltf_radiosity
