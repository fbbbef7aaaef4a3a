#include "plugin/export_light_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include "plugin/check_document.h"
#include "plugin/morph_weights.h"
#include "plugin/our_extras.h"

namespace gltf_radiosity {
namespace {

using radiosity::Rgb;

// --- Names

/// `name` of letters, digits and underscores; everything else becomes an underscore.
std::string plain_name(const std::string& name) {
  std::string plain = name;
  for (char& c : plain) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return plain;
}

std::string upper_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// `name`, or with a number behind it, so that no case of it is in `taken`, where it is put.
std::string unique_name(const std::string& name, std::set<std::string>& taken) {
  std::string unique = name;
  for (int number = 2; !taken.insert(upper_case(unique)).second; ++number) unique = fmt::format("{}_{}", name, number);
  return unique;
}

/// The names of all morph targets of a file.
std::set<std::string> target_names(const Json& root) {
  std::set<std::string> names;
  for (const Json& mesh : array_of(root, "meshes")) {
    const Json* list = member_at(mesh, {"extras", "targetNames"});
    if (list == nullptr || !list->is_array()) continue;
    for (const Json& name : *list) {
      if (name.is_string()) names.insert(name.get<std::string>());
    }
  }
  return names;
}

// --- Morph targets

/// An accessor of zeros that takes no room in the file.
std::size_t zeros(Document& document, int component, const char* type, std::size_t count, bool with_bounds) {
  Json accessor = {{"componentType", component}, {"count", count}, {"type", type}};
  if (component != static_cast<int>(ComponentType::kF32)) accessor["normalized"] = true;
  if (with_bounds) accessor["min"] = accessor["max"] = {0.0, 0.0, 0.0};
  Json& accessors = document.json["accessors"];
  for (std::size_t i = accessors.size(); i-- > 0 && i + 64 > accessors.size();) {
    if (accessors[i] == accessor) return i;
  }
  accessors.push_back(std::move(accessor));
  return accessors.size() - 1;
}

/// A target that moves nothing: zeros for POSITION and everything that other targets hold.
Json resting_target(Document& document, const std::set<std::string>& semantics, std::size_t count) {
  constexpr int kFloat = static_cast<int>(ComponentType::kF32);
  Json target = {{"POSITION", zeros(document, kFloat, "VEC3", count, true)}};
  for (const std::string& semantic : semantics) {
    if (semantic == "POSITION" || semantic.starts_with("COLOR_")) continue;
    const char* type = semantic.starts_with("TEXCOORD_") ? "VEC2" : "VEC3";
    target[semantic] = zeros(document, kFloat, type, count, false);
  }
  return target;
}

std::set<std::string> semantics_of_targets(const Json& primitive) {
  std::set<std::string> semantics;
  for (const Json& target : array_of(primitive, "targets")) {
    for (const auto& item : target.items()) semantics.insert(item.key());
  }
  return semantics;
}

std::size_t vertex_count_of(const Json& root, const Json& primitive) {
  return root["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()]["count"].get<std::size_t>();
}

VertexColors with_bands(const VertexColors& colors, bool keeps_light, bool keeps_alpha) {
  VertexColors result = colors;
  for (glm::vec4& color : result.unexposed) {
    color = {keeps_light ? Rgb(color) : Rgb(0.0F), keeps_alpha ? color.a : 0.0F};
  }
  return result;
}

void add_targets(GroupExport& groups, const VertexColors& whole, std::span<const VertexColors> of_group,
                 std::span<const std::uint32_t> kept, const Rgb& k, Json& primitive) {
  // What moved the mesh adds no colour.
  Document& document = groups.document;
  const std::size_t count = vertex_count_of(document.json, primitive);
  const std::set<std::string> semantics = semantics_of_targets(primitive);
  const auto component =
      document.json["accessors"][primitive["attributes"]["COLOR_0"].get<std::size_t>()]["componentType"].get<int>();
  if (!primitive.contains("targets")) primitive["targets"] = Json::array();
  for (Json& target : primitive["targets"]) target["COLOR_0"] = zeros(document, component, "VEC4", count, false);

  // The groups do.
  primitive["attributes"]["COLOR_0"] =
      export_color_accessor(document, groups.buffer, with_bands(whole, false, true), kept, k, groups.color_type);
  for (const VertexColors& colors : of_group) {
    Json target = resting_target(document, semantics, count);
    target["COLOR_0"] =
        export_color_accessor(document, groups.buffer, with_bands(colors, true, false), kept, k, groups.color_type);
    primitive["targets"].push_back(std::move(target));
  }
}

// --- Attributes

void add_attributes(GroupExport& groups, std::span<const VertexColors> of_group, std::span<const std::uint32_t> kept,
                    const Rgb& k, Json& primitive) {
  for (std::size_t g = 0; g < of_group.size(); ++g) {
    primitive["attributes"][groups.names[g].attribute] =
        export_light_accessor(groups.document, groups.buffer, of_group[g], kept, k, groups.color_type);
  }
}

// --- Files

void add_bytes(GroupExport& groups, std::span<const VertexColors> of_group, std::span<const std::uint32_t> kept,
               const Rgb& k, const Json& primitive) {
  const Json& root = groups.document.json;
  const Json& accessor = root["accessors"][primitive["attributes"]["COLOR_0"].get<std::size_t>()];
  const Json& view = root["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  groups.bytes.resize(of_group.size());
  for (std::size_t g = 0; g < of_group.size(); ++g) {
    groups.bytes[g].push_back(
        {view["byteOffset"].get<std::size_t>(), picked(color_rows(of_group[g], k, groups.color_type), kept).bytes});
  }
}

}  // namespace

std::vector<GroupNames> group_names(const Json& root, std::span<const std::string> names) {
  const std::set<std::string> targets = target_names(root);
  std::set<std::string> attributes, files;
  std::vector<GroupNames> result;
  for (const std::string& name : names) {
    const std::string plain = plain_name(name);
    result.push_back({name, unique_name("_LIGHT_" + upper_case(plain), attributes),
                      targets.contains(name) ? name + " light" : name, unique_name(plain, files)});
  }
  return result;
}

void export_group_colors(GroupExport& groups, const VertexColors& whole, std::span<const VertexColors> of_group,
                         std::span<const std::uint32_t> kept, const Rgb& k, std::size_t mesh, Json& primitive) {
  switch (groups.storage) {
    case LightGroupStorage::kMorph:
      add_targets(groups, whole, of_group, kept, k, primitive);
      groups.morphed_meshes.insert(mesh);
      break;
    case LightGroupStorage::kAttributes:
      add_attributes(groups, of_group, kept, k, primitive);
      break;
    case LightGroupStorage::kFiles:
      add_bytes(groups, of_group, kept, k, primitive);
      break;
    case LightGroupStorage::kNone:
      break;
  }
}

void finish_groups(GroupExport& groups, std::vector<Warning>& warnings) {
  if (groups.storage == LightGroupStorage::kNone) return;

  // Meshes whose primitives were not all baked.
  Document& document = groups.document;
  const std::size_t group_count = groups.names.size();
  for (const std::size_t mesh : groups.morphed_meshes) {
    std::size_t target_count = 0;
    for (const Json& primitive : document.json["meshes"][mesh]["primitives"]) {
      target_count = std::max(target_count, array_of(primitive, "targets").size());
    }
    for (std::size_t i = 0; i < document.json["meshes"][mesh]["primitives"].size(); ++i) {
      Json primitive = document.json["meshes"][mesh]["primitives"][i];
      const bool has_positions = primitive.contains("attributes") && primitive["attributes"].contains("POSITION");
      while (has_positions && array_of(primitive, "targets").size() < target_count) {
        const std::size_t count = vertex_count_of(document.json, primitive);
        primitive["targets"].push_back(resting_target(document, semantics_of_targets(primitive), count));
      }
      document.json["meshes"][mesh]["primitives"][i] = std::move(primitive);
    }
    std::vector<std::string> added;
    for (const GroupNames& names : groups.names) added.push_back(names.target);
    add_morph_weights(document, groups.buffer, mesh, {target_count - group_count, added}, warnings);
  }

  // What was done.
  Json list = Json::array();
  for (const GroupNames& names : groups.names) {
    Json entry = {{"name", names.name}};
    if (groups.storage == LightGroupStorage::kMorph) entry["target"] = names.target;
    if (groups.storage == LightGroupStorage::kAttributes) entry["attribute"] = names.attribute;
    list.push_back(std::move(entry));
  }
  our_extras(document.json["asset"])["lightGroups"] = {{"storage", name_of(groups.storage)},
                                                       {"groups", std::move(list)}};
}

Result<Done> check_group_attributes_are_free(const Document& document, const Options& options,
                                             std::span<const std::string> names) {
  if (options.light_groups != LightGroupStorage::kAttributes) return Done{};
  for (const GroupNames& group : group_names(document.json, names)) {
    for (std::size_t mesh = 0; mesh < document.json["meshes"].size(); ++mesh) {
      const Json& primitives = document.json["meshes"][mesh]["primitives"];
      for (std::size_t i = 0; i < primitives.size(); ++i) {
        if (!primitives[i]["attributes"].contains(group.attribute)) continue;
        return Error{ErrorCode::kBadOption, "--light-groups",
                     place_of_primitive(mesh, i) + " has an attribute " + group.attribute + " already"};
      }
    }
  }
  return Done{};
}

}  // namespace gltf_radiosity
