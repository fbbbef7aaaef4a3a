#include "plugin/export_materials.h"

#include <charconv>
#include <string>
#include <string_view>
#include <utility>

#include "plugin/json_checker.h"
#include "plugin/used_extensions.h"

namespace gltf_radiosity {
namespace {

constexpr const char* kGlossy = "KHR_materials_pbrSpecularGlossiness";
constexpr std::string_view kPointer = "/materials/";

/// Extensions of a material that say how it reflects light, or repack textures that do.
bool shades(std::string_view extension) {
  return extension.starts_with("KHR_materials_") || extension.starts_with("EXT_materials_") ||
         extension.starts_with("ADOBE_materials_") || extension.starts_with("MSFT_packing_");
}

/// Calls `visit(key, value)` for every member of every object in the tree; elements of arrays have their array's key.
template <typename Visit>
void walk(const Json& value, const std::string& key, const Visit& visit) {
  if (value.is_object()) {
    for (const auto& item : value.items()) {
      visit(item.key(), item.value());
      walk(item.value(), item.key(), visit);
    }
  } else if (value.is_array()) {
    for (const Json& element : value) {
      visit(key, element);
      walk(element, key, visit);
    }
  }
}

/// The colour and alpha owner[key], ones where there is none, times `factor`.
void dim(Json& owner, const char* key, const radiosity::Rgb& factor) {
  Json color = owner.contains(key) ? owner[key] : Json({1.0, 1.0, 1.0, 1.0});
  for (int band = 0; band < 3; ++band) {
    Json& share = color[static_cast<std::size_t>(band)];
    share = share.get<double>() * static_cast<double>(factor[band]);
  }
  owner[key] = std::move(color);
}

}  // namespace

Json unlit_material(const Json& source, const ImportedMaterial& material, const radiosity::Rgb& factor,
                    ShownTexture texture) {
  Json unlit = source.is_object() ? source : Json::object();

  // Base colour: COLOR_0 holds the source's factor. Specular-glossiness has a texture of its own for it.
  const Json* glossy = extension_of(source, kGlossy);
  Json& pbr = unlit["pbrMetallicRoughness"];
  if (!pbr.is_object()) pbr = Json::object();
  if (glossy != nullptr) pbr.erase("baseColorTexture");
  if (glossy != nullptr && glossy->contains("diffuseTexture")) pbr["baseColorTexture"] = (*glossy)["diffuseTexture"];
  if (texture == ShownTexture::kEmissive) pbr["baseColorTexture"] = source["emissiveTexture"];
  pbr.erase("metallicRoughnessTexture");
  pbr.erase("baseColorFactor");
  const glm::vec4 left(factor, material.base_color_factor.a);
  if (left != glm::vec4(1.0F)) pbr["baseColorFactor"] = {left.r, left.g, left.b, left.a};
  pbr["metallicFactor"] = 0.0;
  pbr["roughnessFactor"] = 1.0;

  // What unlit does not show.
  for (const char* key : {"emissiveFactor", "emissiveTexture", "normalTexture", "occlusionTexture"}) unlit.erase(key);
  Json extensions = Json::object();
  if (unlit.contains("extensions")) {
    for (const auto& item : unlit["extensions"].items()) {
      if (!shades(item.key())) extensions[item.key()] = item.value();
    }
  }
  extensions[kUnlitExtension] = Json::object();
  unlit["extensions"] = std::move(extensions);
  return unlit;
}

Json dimmed_material(const Json& source, const radiosity::Rgb& factor) {
  Json dimmed = source.is_object() ? source : Json::object();
  dim(dimmed["pbrMetallicRoughness"], "baseColorFactor", factor);
  if (extension_of(source, kGlossy) != nullptr) dim(dimmed["extensions"][kGlossy], "diffuseFactor", factor);
  return dimmed;
}

std::size_t export_material(Document& document, const ImportedMaterial& material, Json baked,
                            std::set<std::size_t>& referenced) {
  Json& materials = document.json["materials"];
  const bool in_place = material.source && !referenced.contains(*material.source);
  const std::size_t index = in_place ? *material.source : materials.size();
  if (in_place) {
    materials[index] = std::move(baked);
  } else {
    materials.push_back(std::move(baked));
  }
  referenced.insert(index);
  return index;
}

std::set<std::size_t> referenced_materials(const Json& root) {
  std::set<std::size_t> referenced;
  walk(root, "", [&](const std::string& key, const Json& value) {
    // Extensions may mean anything by these words: what is no index refers to nothing.
    const auto number = key == "material" || key == "materials" ? whole_number(value) : std::nullopt;
    if (number) referenced.insert(*number);
    if (value.is_string()) {
      const std::string& text = value.get_ref<const std::string&>();
      std::size_t index = 0;
      if (text.starts_with(kPointer) &&
          std::from_chars(text.data() + kPointer.size(), text.data() + text.size(), index).ec == std::errc()) {
        referenced.insert(index);
      }
    }
    if (key == "MSFT_lod" && value.is_object() && value.contains("ids")) {
      for (const Json& id : value["ids"]) {
        if (const auto lod = whole_number(id)) referenced.insert(*lod);
      }
    }
  });
  return referenced;
}

void forget_unused_material_extensions(Json& root) {
  // Declared, and once on materials.
  std::set<std::string> unused;
  for (const char* array : {"extensionsUsed", "extensionsRequired"}) {
    if (!root.contains(array)) continue;
    for (const Json& name : root[array]) {
      if (name.is_string() && shades(name.get_ref<const std::string&>())) unused.insert(name.get<std::string>());
    }
  }

  // Still there.
  walk(root, "", [&](const std::string& key, const Json& value) {
    if (key != "extensions" || !value.is_object()) return;
    for (const auto& item : value.items()) unused.erase(item.key());
  });
  unused.erase(kVariantsExtension);  // its list of names stays at the root
  for (const std::string& name : unused) forget_extension(root, name);
}

}  // namespace gltf_radiosity
