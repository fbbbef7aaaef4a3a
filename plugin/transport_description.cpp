#include "plugin/transport_description.h"

#include <algorithm>
#include <cmath>

namespace gltf_radiosity {
namespace {

using radiosity::Rgb;

Json json_of(const Rgb& rgb) { return Json::array({rgb.x, rgb.y, rgb.z}); }

Rgb rgb_of(const Json& json) { return {json.at(0).get<float>(), json.at(1).get<float>(), json.at(2).get<float>()}; }

Json json_of(const std::optional<std::uint32_t>& index) { return index ? Json(*index) : Json(nullptr); }

std::optional<std::uint32_t> index_of(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<std::uint32_t>());
}

Json json_of(const LightSource& source) {
  return {{"kind", static_cast<int>(source.kind)},
          {"name", source.name},
          {"nodes", source.nodes},
          {"source", json_of(source.source)},
          {"strength", json_of(source.strength)},
          {"color", json_of(source.color)},
          {"coreUnits", source.core_units}};
}

LightSource source_of(const Json& json) {
  return {.kind = static_cast<LightSource::Kind>(json.at("kind").get<int>()),
          .name = json.at("name").get<std::string>(),
          .nodes = json.at("nodes").get<std::vector<std::string>>(),
          .source = index_of(json.at("source")),
          .strength = rgb_of(json.at("strength")),
          .color = rgb_of(json.at("color")),
          .core_units = json.at("coreUnits").get<float>()};
}

Json json_of(const TransportMaterial& material) {
  return {{"name", material.name},
          {"source", json_of(material.source)},
          {"factor", json_of(material.factor)},
          {"shines", json_of(material.shines)},
          {"transmits", material.transmits}};
}

TransportMaterial material_of(const Json& json) {
  return {json.at("name").get<std::string>(), index_of(json.at("source")), rgb_of(json.at("factor")),
          index_of(json.at("shines")), json.at("transmits").get<bool>()};
}

Json json_of(const TransportPrimitive& primitive) {
  return {{"mesh", primitive.mesh},          {"primitive", primitive.primitive},
          {"material", primitive.material},  {"factor", json_of(primitive.factor)},
          {"firstRow", primitive.first_row}, {"rowCount", primitive.row_count}};
}

TransportPrimitive primitive_of(const Json& json) {
  return {json.at("mesh").get<std::size_t>(),       json.at("primitive").get<std::size_t>(),
          json.at("material").get<std::uint32_t>(), rgb_of(json.at("factor")),
          json.at("firstRow").get<std::uint64_t>(), json.at("rowCount").get<std::uint64_t>()};
}

template <typename T>
Json list_of(const std::vector<T>& values) {
  Json list = Json::array();
  for (const T& value : values) list.push_back(json_of(value));
  return list;
}

TransportDescription description_of(const Json& json) {
  TransportDescription description;
  for (const Json& source : json.at("sources")) description.sources.push_back(source_of(source));
  for (const Json& material : json.at("materials")) description.materials.push_back(material_of(material));
  for (const Json& primitive : json.at("primitives")) description.primitives.push_back(primitive_of(primitive));
  description.material_of_surface = json.at("materialOfSurface").get<std::vector<std::uint32_t>>();
  description.exposure = json.at("exposure").get<double>();
  description.geometry = json.at("geometry").get<std::uint64_t>();
  description.scene = index_of(json.at("scene"));
  description.tinted = json.at("tinted").get<bool>();
  description.radiance_semantic = json.at("radiance").get<std::string>();
  description.parts = static_cast<radiosity::LightParts>(json.at("parts").get<int>());
  description.color_type = static_cast<ColorType>(json.at("colorType").get<int>());
  description.draco_bits = json.at("dracoBits").get<int>();
  description.meshopt = json.at("meshopt").get<bool>();
  return description;
}

/// Whether all indices lead somewhere.
bool is_consistent(const TransportDescription& description) {
  const auto is_material = [&](std::uint32_t index) { return index < description.materials.size(); };
  const auto is_known = [&](const TransportMaterial& material) {
    return !material.shines || *material.shines < description.sources.size();
  };
  const auto is_of_known = [&](const TransportPrimitive& primitive) { return is_material(primitive.material); };
  return std::ranges::all_of(description.materials, is_known) &&
         std::ranges::all_of(description.primitives, is_of_known) &&
         std::ranges::all_of(description.material_of_surface, is_material) && std::isfinite(description.exposure);
}

}  // namespace

std::string to_text(const TransportDescription& description) {
  const Json json = {{"sources", list_of(description.sources)},
                     {"materials", list_of(description.materials)},
                     {"materialOfSurface", description.material_of_surface},
                     {"primitives", list_of(description.primitives)},
                     {"exposure", description.exposure},
                     {"geometry", description.geometry},
                     {"scene", json_of(description.scene)},
                     {"tinted", description.tinted},
                     {"radiance", description.radiance_semantic},
                     {"parts", static_cast<int>(description.parts)},
                     {"colorType", static_cast<int>(description.color_type)},
                     {"dracoBits", description.draco_bits},
                     {"meshopt", description.meshopt}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Result<TransportDescription> read_description(const std::string& text) {
  const Error wrong{ErrorCode::kBadInput, "", "holds no description of a transport"};
  try {
    TransportDescription description = description_of(Json::parse(text));
    if (!is_consistent(description)) return wrong;
    return description;
  } catch (const Json::exception&) {
    return wrong;
  }
}

}  // namespace gltf_radiosity
