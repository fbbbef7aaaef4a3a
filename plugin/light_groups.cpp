#include "plugin/light_groups.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "plugin/check_document.h"

namespace gltf_radiosity {
namespace {

constexpr const char* kOther = "other";

/// Something that shines, and where the core scene keeps its light group.
struct Emitter {
  std::vector<std::string> names;     ///< that patterns are compared with; the first that is not empty is its own
  std::string place;                  ///< its name if it has none
  std::optional<std::string> chosen;  ///< by extras
  std::vector<std::uint32_t*> groups;

  std::string own_name() const {
    const auto named = std::ranges::find_if(names, [](const std::string& name) { return !name.empty(); });
    return named == names.end() ? place : *named;
  }
};

std::string name_of(const Json& object) { return object.value("name", std::string()); }

/// extras.radiosity.group; a warning if it is there but is no name.
std::optional<std::string> group_in_extras(const Json& object, const std::string& place,
                                           std::vector<Warning>& warnings) {
  const Json* group = member_at(object, {"extras", "radiosity", "group"});
  if (group == nullptr) return std::nullopt;
  if (group->is_string() && !group->get_ref<const std::string&>().empty()) return group->get<std::string>();
  warnings.push_back({"bad-group", place, "extras.radiosity.group is no name and was taken for nothing"});
  return std::nullopt;
}

/// The node above each, or none.
std::vector<std::optional<std::size_t>> parents_of(const Json& nodes) {
  std::vector<std::optional<std::size_t>> parents(nodes.size());
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    for (const Json& child : array_of(nodes[node], "children")) parents[child.get<std::size_t>()] = node;
  }
  return parents;
}

void add_punctual_lights(const Document& document, ImportedScene& scene, std::vector<Warning>& warnings,
                         std::vector<Emitter>& emitters) {
  const Json& nodes = array_of(document.json, "nodes");
  const auto parents = parents_of(nodes);
  for (std::size_t i = 0; i < scene.node_of_light.size(); ++i) {
    const std::size_t node = scene.node_of_light[i];
    const std::size_t index = (*extension_of(nodes[node], "KHR_lights_punctual"))["light"].get<std::size_t>();
    const Json& light = document.json["extensions"]["KHR_lights_punctual"]["lights"][index];
    Emitter emitter{{name_of(nodes[node]), name_of(light)}, place_of("nodes", node), {}, {}};
    for (std::optional<std::size_t> above = node; above && !emitter.chosen; above = parents[*above]) {
      emitter.chosen = group_in_extras(nodes[*above], place_of("nodes", *above), warnings);
    }
    emitter.groups.push_back(&scene.scene.lights[i].light_group);
    emitters.push_back(std::move(emitter));
  }
}

void add_emissive_materials(const Document& document, ImportedScene& scene, std::vector<Warning>& warnings,
                            std::vector<Emitter>& emitters) {
  std::map<std::uint32_t, std::size_t> emitter_of_material;
  for (std::size_t s = 0; s < scene.scene.surfaces.size(); ++s) {
    radiosity::Surface& surface = scene.scene.surfaces[s];
    const std::optional<std::uint32_t> material = scene.materials[scene.detail->material_of_surface[s]].source;
    if (surface.emission == radiosity::Rgb(0.0F) || !material) continue;
    const auto [known, is_new] = emitter_of_material.try_emplace(*material, emitters.size());
    if (is_new) {
      const Json& json = document.json["materials"][*material];
      const std::string place = place_of("materials", *material);
      emitters.push_back({{name_of(json)}, place, group_in_extras(json, place, warnings), {}});
    }
    emitters[known->second].groups.push_back(&surface.light_group);
  }
}

void add_surroundings(ImportedScene& scene, std::vector<Emitter>& emitters) {
  for (std::size_t i = scene.node_of_light.size(); i < scene.scene.lights.size(); ++i) {
    emitters.push_back({{"sun"}, "", {}, {&scene.scene.lights[i].light_group}});
  }
  radiosity::Sky& sky = scene.scene.sky;
  if (sky.has_map() || sky.luminance != radiosity::Rgb(0.0F)) emitters.push_back({{"sky"}, "", {}, {&sky.light_group}});
}

bool fits(const std::string& pattern, const Emitter& emitter) {
  return std::ranges::any_of(emitter.names, [&](const std::string& name) {
    return !name.empty() && ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
  });
}

/// options.groups wins over what extras say.
Result<Done> choose_by_patterns(const Options& options, std::vector<Emitter>& emitters) {
  for (const auto& [name, pattern] : options.groups) {
    bool is_used = false;
    for (Emitter& emitter : emitters) {
      if (!fits(pattern, emitter)) continue;
      emitter.chosen = name;
      is_used = true;
    }
    if (is_used) continue;
    std::string known;
    for (const Emitter& emitter : emitters) known += fmt::format("{}{}", known.empty() ? "" : ", ", emitter.own_name());
    return Error{ErrorCode::kBadOption, "--group",
                 fmt::format("nothing that shines is called \"{}\"; there {}", pattern,
                             known.empty() ? "is nothing" : "are " + known)};
  }
  return Done{};
}

/// The number of `name` in `names`, where it is put if it is not there.
std::uint32_t number_of_group(const std::string& name, std::vector<std::string>& names) {
  const auto known = std::ranges::find(names, name);
  if (known == names.end()) {
    names.push_back(name);
    return static_cast<std::uint32_t>(names.size() - 1);
  }
  return static_cast<std::uint32_t>(known - names.begin());
}

/// How many names there are, and which of those that nobody chose have room.
std::vector<std::string> names_with_room(const std::vector<Emitter>& emitters) {
  std::vector<std::string> all;
  for (const Emitter& emitter : emitters) number_of_group(emitter.chosen.value_or(emitter.own_name()), all);
  if (all.size() <= kMaxGroups) return all;
  std::vector<std::string> chosen;
  for (const Emitter& emitter : emitters) {
    if (emitter.chosen) number_of_group(*emitter.chosen, chosen);
  }
  for (const std::string& name : all) {
    if (chosen.size() + 1 < kMaxGroups) number_of_group(name, chosen);
  }
  return chosen;
}

}  // namespace

Result<std::vector<std::string>> group_lights(const Document& document, const Options& options, ImportedScene& scene,
                                              std::vector<Warning>& warnings) {
  // What shines, and what was chosen for it.
  std::vector<Emitter> emitters;
  add_punctual_lights(document, scene, warnings, emitters);
  add_emissive_materials(document, scene, warnings, emitters);
  add_surroundings(scene, emitters);
  if (const auto chosen = choose_by_patterns(options, emitters); !chosen) return chosen.error();

  // Numbers, in the order in which they are met; what does not shine counts with the first.
  for (radiosity::Surface& surface : scene.scene.surfaces) surface.light_group = 0;
  scene.scene.sky.light_group = 0;
  const std::vector<std::string> room = names_with_room(emitters);
  std::vector<std::string> names;
  std::size_t left_over = 0;
  for (const Emitter& emitter : emitters) {
    const std::string wanted = emitter.chosen.value_or(emitter.own_name());
    const bool has_room = std::ranges::find(room, wanted) != room.end();
    left_over += has_room ? 0 : 1;
    const std::uint32_t number = number_of_group(has_room ? wanted : kOther, names);
    for (std::uint32_t* const group : emitter.groups) *group = number;
  }
  if (names.size() > kMaxNamedGroups) {
    return Error{ErrorCode::kBadOption, "--light-groups",
                 fmt::format("{} groups are named, and {} is the most", names.size(), kMaxNamedGroups)};
  }
  if (left_over > 0) {
    warnings.push_back({"light-groups-merged", "",
                        fmt::format("{} lamps and lights beyond the first {} groups share the group \"{}\"; --group "
                                    "names groups",
                                    left_over, kMaxGroups - 1, kOther)});
  }
  if (names.empty()) names.emplace_back("light");
  return names;
}

}  // namespace gltf_radiosity
