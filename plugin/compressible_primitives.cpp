#include "plugin/compressible_primitives.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "plugin/assemble_triangles.h"
#include "plugin/attribute_grid.h"
#include "plugin/check_document.h"
#include "plugin/used_extensions.h"

namespace gltf_radiosity {
namespace {

const Json& primitive_at(const Document& document, const SharedPrimitive::Place& place) {
  return document.json["meshes"][place.mesh]["primitives"][place.primitive];
}

/// The longest edge of the box around the floats of an accessor; 0 for anything else.
float extent_of(const Document& document, std::size_t accessor) {
  const RawAccessor raw = read_accessor(document, accessor);
  if (raw.component != ComponentType::kF32 || raw.components != 3 || raw.count == 0) return 0.0F;
  const std::vector<float> values = as_floats(raw);
  float extent = 0.0F;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    float least = values[axis], most = values[axis];
    for (std::size_t i = axis; i < values.size(); i += 3) {
      least = std::min(least, values[i]);
      most = std::max(most, values[i]);
    }
    extent = std::max(extent, most - least);
  }
  return std::isfinite(extent) ? extent : 0.0F;
}

/// The grid for the positions of each mesh. [mesh_count]
std::vector<int> position_grids(const Document& document) {
  // Extents.
  std::map<std::size_t, float> extent_of_accessor;
  std::vector<float> extents;
  for (const Json& mesh : array_of(document.json, "meshes")) {
    float extent = 0.0F;
    for (const Json& primitive : array_of(mesh, "primitives")) {
      if (!primitive.contains("attributes") || !primitive["attributes"].contains("POSITION")) continue;
      const auto accessor = primitive["attributes"]["POSITION"].get<std::size_t>();
      const auto [known, is_new] = extent_of_accessor.try_emplace(accessor, 0.0F);
      if (is_new) known->second = extent_of(document, accessor);
      extent = std::max(extent, known->second);
    }
    extents.push_back(extent);
  }

  // Grids.
  const float largest = extents.empty() ? 0.0F : *std::max_element(extents.begin(), extents.end());
  std::vector<int> grids;
  grids.reserve(extents.size());
  for (const float extent : extents) grids.push_back(position_grid(extent, largest));
  return grids;
}

bool is_finite(const RawAccessor& raw) {
  if (raw.component != ComponentType::kF32) return true;
  const std::vector<float> floats = as_floats(raw);
  return std::all_of(floats.begin(), floats.end(), [](float value) { return std::isfinite(value); });
}

/// The attributes of a primitive or of a morph target, each of `count` rows; 0 takes the first one's.
Result<std::vector<AttributeValues>> read_attributes(const Document& document, const Json& attributes,
                                                     std::size_t count) {
  std::vector<AttributeValues> values;
  for (const auto& [semantic, accessor] : attributes.items()) {
    AttributeValues attribute{semantic, accessor.get<std::size_t>(), {}};
    attribute.raw = read_accessor(document, attribute.accessor);
    const RawAccessor& raw = attribute.raw;
    if (count == 0) count = raw.count;
    if (raw.components > 4) return bad_input("", fmt::format("{} holds matrices", semantic));
    if (raw.count != count || count == 0) return bad_input("", fmt::format("{} has another number of rows", semantic));
    if (!is_finite(raw)) return bad_input("", fmt::format("{} is not finite", semantic));
    values.push_back(std::move(attribute));
  }
  return values;
}

}  // namespace

std::vector<SharedPrimitive> compressible_primitives(const Document& document, std::vector<Warning>& warnings) {
  const std::vector<int> grids = position_grids(document);
  std::vector<SharedPrimitive> shared;
  std::map<std::string, std::size_t> known;
  for (std::size_t mesh = 0; mesh < grids.size(); ++mesh) {
    const std::size_t primitive_count = array_of(document.json["meshes"][mesh], "primitives").size();
    for (std::size_t i = 0; i < primitive_count; ++i) {
      const SharedPrimitive::Place place{mesh, i};
      const Json& primitive = primitive_at(document, place);
      const int mode = primitive.value("mode", kTriangleList);
      const bool has_positions = primitive.contains("attributes") && primitive["attributes"].contains("POSITION");
      if (mode < kTriangleList || mode > kTriangleFan || !has_positions) continue;
      if (const auto extension = extension_that_names_vertices(primitive)) {
        warnings.push_back(not_compressed(place, *extension + " may name its vertices by their numbers"));
        continue;
      }
      const Json key = {primitive["attributes"], primitive.value("indices", Json()), primitive.value("targets", Json()),
                        mode, grids[mesh]};
      const auto [entry, is_new] = known.try_emplace(key.dump(), shared.size());
      if (is_new) shared.push_back({{}, grids[mesh]});
      shared[entry->second].places.push_back(place);
    }
  }
  return shared;
}

Result<PrimitiveValues> read_values(const Document& document, const SharedPrimitive::Place& place) {
  // Vertices.
  const Json& primitive = primitive_at(document, place);
  PrimitiveValues values;
  auto attributes = read_attributes(document, primitive["attributes"], 0);
  if (!attributes) return attributes.error();
  values.attributes = std::move(*attributes);
  for (const Json& target : array_of(primitive, "targets")) {
    auto moved = read_attributes(document, target, values.vertex_count());
    if (!moved) return moved.error();
    values.targets.push_back(std::move(*moved));
  }

  // Triangles.
  std::vector<std::uint32_t> order(values.vertex_count());
  std::iota(order.begin(), order.end(), 0U);
  if (primitive.contains("indices")) {
    order = as_indices(read_accessor(document, primitive["indices"].get<std::size_t>()));
  }
  const bool in_range =
      std::all_of(order.begin(), order.end(), [&](std::uint32_t vertex) { return vertex < values.vertex_count(); });
  if (!in_range) return bad_input("", "its indices are out of range");
  values.triangles = assemble_triangles(order, primitive.value("mode", kTriangleList));
  std::erase_if(values.triangles, [](const glm::uvec3& t) { return t.x == t.y || t.y == t.z || t.z == t.x; });
  if (values.triangles.empty()) return bad_input("", "no triangle of it has three corners");
  return values;
}

Warning not_compressed(const SharedPrimitive::Place& place, const std::string& why) {
  return {"not-compressed", place_of_primitive(place.mesh, place.primitive), "is not compressed: " + why};
}

}  // namespace gltf_radiosity
