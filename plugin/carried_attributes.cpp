#include "plugin/carried_attributes.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "plugin/used_extensions.h"

namespace gltf_radiosity {
namespace {

using radiosity::Carried;
using radiosity::Rgb;

constexpr float kShapeOfInstance = 1.0F / 10'000.0F, kShapeOfScene = 1.0F / 50'000.0F;
constexpr float kDirectionTolerance = 0.01F, kTexcoordTolerance = 1.0F / 2048.0F, kColorTolerance = 1.0F / 256.0F;
constexpr float kShareOfRange = 1.0F / 1024.0F;
/// Keeps tolerances above nothing, where there is nothing to measure by.
constexpr float kTiny = 1e-12F;

const Json& primitive_of(const Document& document, const PrimitiveInstance& instance) {
  return document.json["meshes"][instance.mesh]["primitives"][instance.primitive];
}

/// The diagonal of the box around points, [3 * count].
float extent_of(std::span<const float> points) {
  glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
  for (std::size_t i = 0; i + 2 < points.size(); i += 3) {
    const glm::vec3 point(points[i], points[i + 1], points[i + 2]);
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  return points.empty() ? 0.0F : glm::length(high - low);
}

/// COLOR_0 as it shows, without alpha.
Rgb exposed(const VertexColors& colors, std::size_t vertex, float k, float white = 1.0F) {
  return glm::clamp(Rgb(colors.unexposed[vertex]) * k, Rgb(0.0F), Rgb(white));
}

/// What rounding to the stored integers may have changed.
float step_of(const RawAccessor& raw) {
  if (raw.component == ComponentType::kF32) return 0.0F;
  if (!raw.normalized) return 1.0F;
  const std::size_t bits = 8 * component_size(raw.component);
  const bool has_sign = raw.component == ComponentType::kI8 || raw.component == ComponentType::kI16;
  return 1.0F / (std::exp2(static_cast<float>(has_sign ? bits - 1 : bits)) - 1.0F);
}

/// Columns of values, one instance at a time.
class Columns {
 public:
  explicit Columns(std::size_t row_count) : row_count_(row_count) {}

  /// One column of `all`, which is `width` wide.
  void add(std::span<const float> all, std::size_t width, std::size_t column, float tolerance) {
    std::vector<float>& scaled = columns_.emplace_back(row_count_);
    for (std::size_t row = 0; row < row_count_; ++row) {
      scaled[row] = all[row * width + column] / std::max(tolerance, kTiny);
    }
  }

  void add_all(const RawAccessor& raw, float tolerance) {
    const std::vector<float> values = as_floats(raw);
    const auto width = static_cast<std::size_t>(raw.components);
    for (std::size_t c = 0; c < width; ++c) add(values, width, c, std::max(tolerance, step_of(raw)));
  }

  /// Each by its own range.
  void add_by_range(const RawAccessor& raw) {
    const std::vector<float> values = as_floats(raw);
    const auto width = static_cast<std::size_t>(raw.components);
    for (std::size_t c = 0; c < width; ++c) {
      float low = values[c], high = values[c];
      for (std::size_t i = c; i < values.size(); i += width) {
        low = std::min(low, values[i]);
        high = std::max(high, values[i]);
      }
      add(values, width, c, std::max(kShareOfRange * (high - low), step_of(raw)));
    }
  }

  /// What tells vertices apart: equal bytes, equal label.
  void add_label(const std::vector<std::uint32_t>& row_label) {
    if (labels_.empty()) labels_.assign(row_count_, 0);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> number;
    for (std::size_t row = 0; row < row_count_; ++row) {
      const auto key = std::pair(labels_[row], row_label[row]);
      labels_[row] = number.try_emplace(key, static_cast<std::uint32_t>(number.size())).first->second;
    }
  }

  void add_label(const RawAccessor& raw) {
    const std::size_t size = static_cast<std::size_t>(raw.components) * component_size(raw.component);
    std::map<std::string, std::uint32_t> number;
    std::vector<std::uint32_t> row_label(row_count_);
    for (std::size_t row = 0; row < row_count_; ++row) {
      const auto first = raw.bytes.begin() + static_cast<std::ptrdiff_t>(row * size);
      const std::string bytes(first, first + static_cast<std::ptrdiff_t>(size));
      row_label[row] = number.try_emplace(bytes, static_cast<std::uint32_t>(number.size())).first->second;
    }
    add_label(row_label);
  }

  std::uint32_t label(std::size_t row) const { return labels_.empty() ? 0 : labels_[row]; }
  std::size_t width() const { return columns_.size(); }
  float value(std::size_t row, std::size_t column) const { return columns_[column][row]; }

 private:
  std::size_t row_count_;
  std::vector<std::vector<float>> columns_;
  std::vector<std::uint32_t> labels_;
};

/// The joints that act on each vertex are its label, by number; their weights are values.
void add_skin(const std::vector<SkinSet>& sets, std::size_t row_count, Columns& columns) {
  if (sets.empty()) return;
  const std::size_t width = 4 * sets.size();
  std::vector<std::vector<std::pair<std::uint32_t, float>>> influences(row_count);
  float step = kColorTolerance;
  for (const SkinSet& set : sets) {
    const std::vector<std::uint32_t> joints = as_indices(set.joints);
    const std::vector<float> weights = as_floats(set.weights);
    step = std::max(step, step_of(set.weights));
    for (std::size_t i = 0; i < 4 * row_count; ++i) {
      if (weights[i] > 0.0F) influences[i / 4].emplace_back(joints[i], weights[i]);
    }
  }
  std::map<std::vector<std::uint32_t>, std::uint32_t> number;
  std::vector<std::uint32_t> label(row_count);
  std::vector<float> weights(row_count * width, 0.0F);
  for (std::size_t row = 0; row < row_count; ++row) {
    std::ranges::sort(influences[row]);
    std::vector<std::uint32_t> joints;
    for (std::size_t i = 0; i < influences[row].size(); ++i) {
      joints.push_back(influences[row][i].first);
      weights[row * width + i] = influences[row][i].second;
    }
    label[row] = number.try_emplace(joints, static_cast<std::uint32_t>(number.size())).first->second;
  }
  columns.add_label(label);
  for (std::size_t c = 0; c < width; ++c) columns.add(weights, width, c, step);
}

/// `shape` is the tolerance of positions, in the space of the mesh.
void add_attribute(std::string_view semantic, const AttributeRows& rows, float shape, Columns& columns) {
  if (rows.how == Interpolation::kLabel) {
    columns.add_label(rows.raw);
  } else if (semantic == "POSITION") {
    columns.add_all(rows.raw, shape);
  } else if (semantic == "NORMAL" || semantic == "TANGENT") {
    columns.add_all(rows.raw, kDirectionTolerance);
  } else if (semantic.starts_with("TEXCOORD_")) {
    columns.add_all(rows.raw, kTexcoordTolerance);
  } else if (semantic.starts_with("COLOR_") || semantic.starts_with("WEIGHTS_")) {
    columns.add_all(rows.raw, kColorTolerance);
  } else {
    columns.add_by_range(rows.raw);
  }
}

Columns columns_of(const Document& document, const PrimitiveInstance& instance, const RefinedPrimitive& refined,
                   const VertexColors& colors, float relative_shape) {
  const Json& primitive = primitive_of(document, instance);
  const Json& attributes = primitive["attributes"];
  Columns columns(refined.vertices.size());

  // Attributes. Positions are the mesh's own matter, colours come with the light.
  const std::vector<SkinSet> skin = skin_rows(document, instance, refined, attributes);
  add_skin(skin, refined.vertices.size(), columns);
  float shape = 0.0F;
  for (const auto& [semantic, accessor] : attributes.items()) {
    if (semantic == "COLOR_0" || is_of_skin(semantic, skin.size())) continue;
    const AttributeRows rows =
        attribute_rows(document, instance, refined, semantic, accessor.get<std::size_t>(), false);
    if (semantic == "POSITION") {
      shape = relative_shape * extent_of(as_floats(rows.raw));
    } else {
      add_attribute(semantic, rows, 0.0F, columns);
    }
  }
  std::vector<float> alpha(refined.vertices.size());
  for (std::size_t v = 0; v < alpha.size(); ++v) alpha[v] = colors.unexposed[v].a;
  columns.add(alpha, 1, 0, kColorTolerance);

  // Morph targets.
  if (!primitive.contains("targets")) return columns;
  for (const Json& target : primitive["targets"]) {
    for (const auto& [semantic, accessor] : target.items()) {
      add_attribute(semantic, attribute_rows(document, instance, refined, semantic, accessor.get<std::size_t>(), true),
                    shape, columns);
    }
  }
  return columns;
}

}  // namespace

MeanColor mean_color(const ExposedColors& colors) {
  MeanColor mean;
  double sum = 0.0;
  for (const VertexColors& primitive : colors.of_instance) {
    for (std::size_t v = 0; v < primitive.samples.size(); ++v) {
      const auto area = static_cast<double>(primitive.samples[v].area);
      mean.area += area;
      sum += area * static_cast<double>(radiosity::luminance_of(exposed(primitive, v, colors.k)));
    }
  }
  if (mean.area > 0.0) mean.luminance = sum / mean.area;
  return mean;
}

bool may_lose_vertices(const Document& document, const PrimitiveInstance& instance) {
  return instance.receives && !extension_that_names_vertices(primitive_of(document, instance));
}

Carried carried_attributes(const Document& document, const ImportedScene& scene, const radiosity::RefinedMesh& mesh,
                           std::span<const RefinedPrimitive> refined, const ExposedColors& colors,
                           const Options& options) {
  const std::size_t count = mesh.positions.size();
  Carried carried;
  carried.light.assign(count, Rgb(0.0F));
  carried.light_tolerance.assign(count, kTiny);
  carried.shape_tolerance.assign(count, kTiny);
  carried.label.assign(count, 0);
  carried.fixed.assign(count, 1);
  const auto mean = static_cast<float>(mean_color(colors).luminance);
  // The radiance attribute goes on where COLOR_0 ends.
  const float white = options.radiance_attribute.empty() ? 1.0F : std::numeric_limits<float>::max();
  const float allowed = static_cast<float>(options.max_error) * mean;
  const float scene_extent = extent_of({&mesh.positions.data()->x, 3 * count});

  // What each instance carries, in its own numbering.
  std::vector<Columns> columns;
  std::vector<std::size_t> width_of_vertex(count, 0);
  std::uint32_t first_label = 0;
  for (std::size_t i = 0; i < refined.size(); ++i) {
    const std::vector<std::uint32_t>& vertices = refined[i].vertices;
    columns.emplace_back(0);
    if (!may_lose_vertices(document, scene.instances[i])) continue;
    std::vector<float> points;
    for (const std::uint32_t v : vertices) points.insert(points.end(), &mesh.positions[v].x, &mesh.positions[v].x + 3);
    const float extent = std::max(extent_of(points), kTiny);
    const float shape = std::max(kTiny, std::min(kShapeOfInstance * extent, kShapeOfScene * scene_extent));
    columns.back() = columns_of(document, scene.instances[i], refined[i], colors.of_instance[i], shape / extent);
    std::uint32_t last_label = 0;
    for (std::size_t row = 0; row < vertices.size(); ++row) {
      const std::uint32_t v = vertices[row];
      carried.light[v] = exposed(colors.of_instance[i], row, colors.k, white);
      const float eye = options.error_space == ErrorSpace::kLinear || !(mean > 0.0F)
                            ? 1.0F
                            : std::sqrt(0.5F * (1.0F + radiosity::luminance_of(carried.light[v]) / mean));
      carried.light_tolerance[v] = std::max(kTiny, allowed * std::min(1.0F, eye));
      carried.shape_tolerance[v] = shape;
      carried.label[v] = first_label + columns.back().label(row);
      carried.fixed[v] = 0;
      width_of_vertex[v] = columns.back().width();
      last_label = std::max(last_label, columns.back().label(row));
    }
    first_label += last_label + 1;
  }

  // All together.
  carried.first_value.assign(count + 1, 0);
  for (std::size_t v = 0; v < count; ++v) carried.first_value[v + 1] = carried.first_value[v] + width_of_vertex[v];
  carried.values.resize(carried.first_value.back());
  for (std::size_t i = 0; i < refined.size(); ++i) {
    for (std::size_t row = 0; row < refined[i].vertices.size(); ++row) {
      const std::size_t first = carried.first_value[refined[i].vertices[row]];
      for (std::size_t c = 0; c < columns[i].width(); ++c) carried.values[first + c] = columns[i].value(row, c);
    }
  }
  return carried;
}

}  // namespace gltf_radiosity
