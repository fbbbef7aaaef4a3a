#include "plugin/strip_lights.h"

#include <array>
#include <string>
#include <vector>

#include "plugin/check_document.h"
#include "plugin/drop_unused.h"
#include "plugin/used_extensions.h"

namespace gltf_radiosity {
namespace {

constexpr const char* kPunctual = "KHR_lights_punctual";
constexpr const char* kImageBased = "EXT_lights_image_based";
constexpr std::array kLights = {kPunctual, kImageBased};

/// The images of all cube maps.
std::vector<std::size_t> images_of_lights(const Json& root) {
  std::vector<std::size_t> images;
  const Json* extension = extension_of(root, kImageBased);
  if (extension == nullptr) return images;
  for (const Json& light : array_of(*extension, "lights")) {
    for (const Json& level : array_of(light, "specularImages")) {
      for (const Json& image : level) images.push_back(image.get<std::size_t>());
    }
  }
  return images;
}

/// KHR_animation_pointer: whether a channel moves a light.
bool moves_a_light(const Json& channel) {
  const Json* pointer = member_at(channel, {"target", "extensions", "KHR_animation_pointer", "pointer"});
  if (pointer == nullptr || !pointer->is_string()) return false;
  const auto text = pointer->get<std::string>();
  return text.find(kPunctual) != std::string::npos || text.find(kImageBased) != std::string::npos;
}

void remove_light_channels(Json& root) {
  if (!root.contains("animations")) return;
  Json kept = Json::array();
  for (Json& animation : root["animations"]) {
    const bool had_channels = !array_of(animation, "channels").empty();
    Json channels = Json::array();
    for (const Json& channel : array_of(animation, "channels")) {
      if (!moves_a_light(channel)) channels.push_back(channel);
    }
    if (had_channels && channels.empty()) continue;  // an animation must move something
    if (had_channels) animation["channels"] = std::move(channels);
    kept.push_back(std::move(animation));
  }
  root["animations"] = std::move(kept);
  if (root["animations"].empty()) root.erase("animations");
}

}  // namespace

void strip_lights(Document& document) {
  Json& root = document.json;
  const std::vector<std::size_t> images = images_of_lights(root);
  for (const char* extension : kLights) {
    remove_extension(root, extension);
    for (const char* array : {"nodes", "scenes"}) {
      if (!root.contains(array)) continue;
      for (Json& object : root[array]) remove_extension(object, extension);
    }
    forget_extension(root, extension);
  }
  remove_light_channels(root);
  drop_images(document, images);
}

}  // namespace gltf_radiosity
