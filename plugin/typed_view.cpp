// A sanitised copy of the JSON tree -> tinygltf: only what this project asks for, checked and in a shape tinygltf
// accepts.
#include <tiny_gltf.h>

#include <cmath>
#include <initializer_list>
#include <limits>

#include "plugin/check_document.h"
#include "plugin/document.h"

namespace gltf_radiosity {
namespace {

/// 3.0 -> 3, which tinygltf wants for indices; it takes whole numbers for real ones as well.
void make_whole(Json& value) {
  if (value.is_structured()) {
    for (Json& element : value) make_whole(element);
  } else if (value.is_number_float()) {
    const double real = value.get<double>();
    if (std::abs(real) < 1e9 && real == std::floor(real)) value = static_cast<std::int64_t>(real);
  }
}

Json copy_members(const Json& from, std::initializer_list<const char*> keys) {
  Json to = Json::object();
  for (const char* key : keys) {
    if (const auto it = from.find(key); it != from.end()) to[key] = *it;
  }
  return to;
}

template <typename Copy>
void copy_array(const Json& from, const char* key, Json& to, Copy copy) {
  const Json& elements = array_of(from, key);
  if (elements.empty()) return;
  to[key] = Json::array();
  for (const Json& element : elements) to[key].push_back(copy(element));
}

Json copy_texture_info(const Json& info) { return copy_members(info, {"index", "texCoord"}); }

Json copy_node(const Json& node) {
  Json copy =
      copy_members(node, {"name", "mesh", "skin", "children", "weights", "matrix", "translation", "rotation", "scale"});
  if (const Json* light = extension_of(node, "KHR_lights_punctual")) {
    copy["extensions"]["KHR_lights_punctual"]["light"] = (*light)["light"];
  }
  return copy;
}

Json copy_mesh(const Json& mesh) {
  Json copy = copy_members(mesh, {"name", "weights"});
  copy["primitives"] = Json::array();
  for (const Json& primitive : array_of(mesh, "primitives")) {
    Json& parts = copy["primitives"].emplace_back(
        copy_members(primitive, {"attributes", "indices", "material", "mode", "targets"}));
    // tinygltf drops primitives without attributes, and every index after them would be off by one.
    if (parts["attributes"].empty()) parts["attributes"]["_NONE"] = -1;
  }
  return copy;
}

Json copy_material(const Json& material) {
  Json copy = copy_members(material, {"name", "emissiveFactor", "alphaMode", "alphaCutoff", "doubleSided"});
  if (material.contains("emissiveTexture")) copy["emissiveTexture"] = copy_texture_info(material["emissiveTexture"]);
  if (material.contains("pbrMetallicRoughness")) {
    const Json& pbr = material["pbrMetallicRoughness"];
    copy["pbrMetallicRoughness"] = copy_members(pbr, {"baseColorFactor", "metallicFactor"});
    for (const char* key : {"baseColorTexture", "metallicRoughnessTexture"}) {
      if (pbr.contains(key)) copy["pbrMetallicRoughness"][key] = copy_texture_info(pbr[key]);
    }
  }
  return copy;
}

Json copy_light(const Json& light) {
  Json copy = copy_members(light, {"name", "type", "color", "intensity", "range", "spot"});
  if (!copy.contains("spot")) copy["spot"] = Json::object();
  copy["spot"] = copy_members(copy["spot"], {"innerConeAngle", "outerConeAngle"});
  return copy;
}

Json sanitised(const Json& root) {
  Json copy;
  copy["asset"] = {{"version", "2.0"}};
  if (root.contains("scene")) copy["scene"] = root["scene"];
  copy_array(root, "scenes", copy, [](const Json& scene) { return copy_members(scene, {"name", "nodes"}); });
  copy_array(root, "nodes", copy, copy_node);
  copy_array(root, "meshes", copy, copy_mesh);
  copy_array(root, "materials", copy, copy_material);
  copy_array(root, "textures", copy, [](const Json& texture) { return copy_members(texture, {"source", "sampler"}); });
  copy_array(root, "samplers", copy, [](const Json& sampler) { return copy_members(sampler, {"wrapS", "wrapT"}); });
  copy_array(root, "skins", copy, [](const Json& skin) {
    return copy_members(skin, {"joints", "inverseBindMatrices"});
  });
  copy_array(root, "accessors", copy, [](const Json& accessor) {
    return copy_members(accessor, {"bufferView", "byteOffset", "componentType", "normalized", "count", "type"});
  });
  // An empty buffer stands for each, so that tinygltf has nothing to load.
  copy_array(root, "bufferViews", copy, [](const Json&) { return Json{{"buffer", 0}, {"byteLength", 1}}; });
  if (const Json* lights = extension_of(root, "KHR_lights_punctual")) {
    copy["extensions"]["KHR_lights_punctual"] = Json::object();
    copy_array(*lights, "lights", copy["extensions"]["KHR_lights_punctual"], copy_light);
  }
  make_whole(copy);
  return copy;
}

}  // namespace

Result<std::shared_ptr<const tinygltf::Model>> typed_view(const Document& document) {
  const std::string text = sanitised(document.json).dump(-1, ' ', true);
  if (text.size() > std::numeric_limits<unsigned>::max()) return bad_input("JSON", "is too large");
  auto model = std::make_shared<tinygltf::Model>();
  tinygltf::TinyGLTF loader;
  std::string error, warning;
  // What was checked cannot fail; if it does all the same, the fault is ours.
  bool loaded = false;
  try {
    loaded = loader.LoadASCIIFromString(model.get(), &error, &warning, text.data(), static_cast<unsigned>(text.size()),
                                        "", tinygltf::NO_REQUIRE);
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  const bool agrees = model->nodes.size() == array_of(document.json, "nodes").size() &&
                      model->meshes.size() == array_of(document.json, "meshes").size() &&
                      model->materials.size() == array_of(document.json, "materials").size();
  if (!loaded || !agrees) return Error{ErrorCode::kInternal, "typed view", error.substr(0, error.find('\n'))};
  return std::shared_ptr<const tinygltf::Model>(std::move(model));
}

}  // namespace gltf_radiosity
