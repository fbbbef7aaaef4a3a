#include "plugin/used_extensions.h"

#include <algorithm>

namespace gltf_radiosity {

void declare_extension(Json& root, const std::string& extension) {
  Json& used = root["extensionsUsed"];
  if (std::find(used.begin(), used.end(), Json(extension)) == used.end()) used.push_back(extension);
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

}  // namespace gltf_radiosity
