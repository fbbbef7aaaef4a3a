#include "plugin/light_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <string>

#include "plugin/export_materials.h"
#include "plugin/used_extensions.h"

namespace gltf_radiosity {
namespace {

using radiosity::Rgb;

Rgb rgb_of(const std::array<double, 3>& value) {
  return {static_cast<float>(value[0]), static_cast<float>(value[1]), static_cast<float>(value[2])};
}

Result<Done> check_amount(const Rgb& amount, const std::string& option, float most) {
  if (radiosity::is_light(amount) && std::max({amount.x, amount.y, amount.z}) <= most) return Done{};
  return Error{ErrorCode::kBadOption, option, most > 1.0F ? "is negative or not finite" : "must lie in [0,1]"};
}

bool is_called(const LightSource& source, const std::string& name) {
  return source.name == name || std::ranges::count(source.nodes, name) > 0;
}

/// "there is no light 'x'; there are: a, b" (or none at all).
Error no_such_name(const char* option, const char* what, const std::string& name, std::vector<std::string> known) {
  std::ranges::sort(known);
  known.erase(std::unique(known.begin(), known.end()), known.end());
  const std::string there = known.empty() ? "there is none" : fmt::format("there are: {}", fmt::join(known, ", "));
  return {ErrorCode::kBadOption, option, fmt::format("no {} is called '{}'; {}", what, name, there)};
}

/// The sources of the kinds, with this name or, without one, all.
std::vector<std::size_t> find_sources(const TransportDescription& description,
                                      std::initializer_list<LightSource::Kind> kinds, const std::string* name) {
  std::vector<std::size_t> found;
  for (std::size_t s = 0; s < description.sources.size(); ++s) {
    const LightSource& source = description.sources[s];
    const bool is_kind = std::ranges::count(kinds, source.kind) > 0;
    if (is_kind && (name == nullptr || is_called(source, *name))) found.push_back(s);
  }
  return found;
}

std::vector<std::string> names_of(const TransportDescription& description, const std::vector<std::size_t>& sources) {
  std::vector<std::string> names;
  names.reserve(sources.size());
  for (const std::size_t s : sources) names.push_back(description.sources[s].name);
  return names;
}

/// The strength of a light of another colour, another intensity or both.
Rgb changed_strength(const LightSource& light, const LightChange& change) {
  float old_intensity = 0.0F;
  for (int band = 0; band < 3; ++band) {
    if (light.color[band] > 0.0F) old_intensity = light.strength[band] / light.color[band];
  }
  const Rgb color = change.color ? rgb_of(*change.color) : light.color;
  return color * (change.intensity ? static_cast<float>(*change.intensity) : old_intensity);
}

Result<Done> change_lights(const TransportDescription& description, const RelightOptions& options,
                           ChangedLight& changed) {
  const auto kinds = {LightSource::Kind::kLight, LightSource::Kind::kSun};
  for (const auto& [name, change] : options.lights) {
    const std::vector<std::size_t> found = find_sources(description, kinds, &name);
    if (found.empty()) {
      return no_such_name("--light", "light", name, names_of(description, find_sources(description, kinds, nullptr)));
    }
    for (const std::size_t s : found) {
      changed.strength[s] = changed_strength(description.sources[s], change);
      if (auto fine = check_amount(changed.strength[s], "--light " + name, 1e30F); !fine) return fine;
      changed.sources.push_back(s);
    }
  }
  return Done{};
}

Result<Done> change_emissive(const TransportDescription& description, const RelightOptions& options,
                             ChangedLight& changed) {
  const auto kinds = {LightSource::Kind::kMaterial};
  for (const auto& [name, change] : options.emissive) {
    const std::vector<std::size_t> found = find_sources(description, kinds, &name);
    if (found.empty()) {
      return no_such_name("--emissive", "material that emits light", name,
                          names_of(description, find_sources(description, kinds, nullptr)));
    }
    for (const std::size_t s : found) {
      const Rgb old = change.luminance ? rgb_of(*change.luminance) : description.sources[s].strength;
      changed.strength[s] = old * static_cast<float>(change.scale.value_or(1.0));
      if (auto fine = check_amount(changed.strength[s], "--emissive " + name, 1e30F); !fine) return fine;
      changed.sources.push_back(s);
    }
  }
  return Done{};
}

Result<Done> change_sky(const TransportDescription& description, const RelightOptions& options, ChangedLight& changed) {
  if (!options.sky) return Done{};
  const std::vector<std::size_t> found = find_sources(description, {LightSource::Kind::kSky}, nullptr);
  if (found.empty()) {
    return Error{ErrorCode::kBadOption, "--sky", "the bake had no sky: bake with --sky 0,0,0 to be able to light it"};
  }
  changed.strength[found.front()] = rgb_of(*options.sky);
  changed.sources.push_back(found.front());
  return check_amount(changed.strength[found.front()], "--sky", 1e30F);
}

Result<Done> change_reflectance(const TransportDescription& description, const RelightOptions& options,
                                ChangedLight& changed) {
  for (const auto& [name, color] : options.reflectance) {
    std::vector<std::string> known;
    bool is_known = false;
    for (std::size_t m = 0; m < description.materials.size(); ++m) {
      const TransportMaterial& material = description.materials[m];
      known.push_back(material.name);
      if (material.name != name) continue;
      if (material.transmits) {
        return Error{ErrorCode::kBadOption, "--reflectance " + name,
                     "lets light through: how much follows from its colour, so it must be baked anew"};
      }
      is_known = true;
      changed.factor[m] = rgb_of(color);
      changed.materials.push_back(m);
      if (auto fine = check_amount(changed.factor[m], "--reflectance " + name, 1.0F); !fine) return fine;
    }
    if (!is_known) return no_such_name("--reflectance", "material", name, std::move(known));
  }
  return Done{};
}

Json bands_of(const Rgb& rgb) { return Json::array({rgb.x, rgb.y, rgb.z}); }

void change_light(const Rgb& strength, Json& light) {
  const float brightest = std::max({strength.x, strength.y, strength.z});
  light["intensity"] = brightest;
  light["color"] = brightest > 0.0F ? bands_of(strength / brightest) : bands_of(Rgb(1.0F));
}

/// glTF's factor is at most 1; the rest is an extension's.
void change_emission(const Rgb& luminance, Json& root, Json& material) {
  const float brightest = std::max({luminance.x, luminance.y, luminance.z});
  remove_extension(material, "KHR_materials_emissive_strength");
  material["emissiveFactor"] = bands_of(brightest > 1.0F ? luminance / brightest : luminance);
  if (!(brightest > 1.0F)) return;
  material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = brightest;
  declare_extension(root, "KHR_materials_emissive_strength");
}

void change_base_color(const Rgb& factor, Json& material) {
  Json& pbr = material["pbrMetallicRoughness"];
  const float alpha = pbr.contains("baseColorFactor") ? pbr["baseColorFactor"].at(3).get<float>() : 1.0F;
  pbr["baseColorFactor"] = Json::array({factor.x, factor.y, factor.z, alpha});
}

/// The material of the document, if it is lit still.
Json* lit_material(const std::optional<std::uint32_t>& source, Json& root) {
  if (!source || !root.contains("materials") || *source >= root["materials"].size()) return nullptr;
  Json& material = root["materials"][*source];
  const bool unlit = material.contains("extensions") && material["extensions"].contains(kUnlitExtension);
  return unlit ? nullptr : &material;
}

/// The lights of the document; none if they were stripped.
Json* lights_of(Json& root) {
  if (!root.contains("extensions") || !root["extensions"].contains("KHR_lights_punctual")) return nullptr;
  return &root["extensions"]["KHR_lights_punctual"]["lights"];
}

}  // namespace

Result<ChangedLight> changed_light(const TransportDescription& description, const RelightOptions& options) {
  ChangedLight changed;
  for (const LightSource& source : description.sources) changed.strength.push_back(source.strength);
  for (const TransportMaterial& material : description.materials) changed.factor.push_back(material.factor);
  for (const auto change : {change_lights, change_emissive, change_sky, change_reflectance}) {
    if (auto done = change(description, options, changed); !done) return done.error();
  }
  return changed;
}

std::vector<Rgb> dimmers_of(const TransportDescription& description, const ChangedLight& changed) {
  std::vector<Rgb> dimmers;
  for (std::size_t s = 0; s < description.sources.size(); ++s) {
    dimmers.push_back(changed.strength[s] / shining_strength(description.sources[s].strength));
  }
  if (dimmers.empty()) dimmers.emplace_back(1.0F);
  return dimmers;
}

void change_document(const TransportDescription& description, const ChangedLight& changed, Json& root) {
  for (const std::size_t s : changed.sources) {
    const LightSource& source = description.sources[s];
    Json* lights = lights_of(root);
    if (source.kind == LightSource::Kind::kLight && lights != nullptr && *source.source < lights->size()) {
      change_light(changed.strength[s], (*lights)[*source.source]);
    }
    Json* material = source.kind == LightSource::Kind::kMaterial ? lit_material(source.source, root) : nullptr;
    if (material != nullptr) change_emission(changed.strength[s], root, *material);
  }
  for (const std::size_t m : changed.materials) {
    Json* material = lit_material(description.materials[m].source, root);
    if (material != nullptr) change_base_color(changed.factor[m], *material);
  }
}

}  // namespace gltf_radiosity
