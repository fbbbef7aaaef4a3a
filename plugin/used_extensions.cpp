#include "plugin/used_extensions.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace gltf_radiosity {
namespace {

/// Extensions of primitives that do not care about the order of vertices.
constexpr std::array<std::string_view, 3> kOrderless = {"KHR_materials_variants", "EXT_mesh_features",
                                                        "EXT_structural_metadata"};

void add_name(Json& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), Json(name)) == names.end()) names.push_back(name);
}

}  // namespace

void declare_extension(Json& root, const std::string& extension) { add_name(root["extensionsUsed"], extension); }

void require_extension(Json& root, const std::string& extension) {
  declare_extension(root, extension);
  add_name(root["extensionsRequired"], extension);
}

void forget_extension(Json& root, const std::string& extension) {
  for (const char* array : {"extensionsUsed", "extensionsRequired"}) {
    if (!root.contains(array)) continue;
    Json& names = root[array];
    names.erase(std::remove(names.begin(), names.end(), Json(extension)), names.end());
    if (names.empty()) root.erase(array);
  }
}

void remove_extension(Json& object, const std::string& extension) {
  if (!object.contains("extensions")) return;
  Json& extensions = object["extensions"];
  extensions.erase(extension);
  if (extensions.empty()) object.erase("extensions");
}

std::optional<std::string> extension_that_names_vertices(const Json& primitive) {
  if (!primitive.contains("extensions")) return std::nullopt;
  for (const auto& item : primitive["extensions"].items()) {
    if (std::find(kOrderless.begin(), kOrderless.end(), item.key()) == kOrderless.end()) return item.key();
  }
  return std::nullopt;
}

}  // namespace gltf_radiosity
