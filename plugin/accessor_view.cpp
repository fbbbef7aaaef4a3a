#include "plugin/accessor_view.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>

namespace gltf_radiosity {
namespace {

struct Shape {
  std::string_view name;
  std::size_t columns, rows;
};
constexpr Shape kShapes[] = {{"SCALAR", 1, 1}, {"VEC2", 1, 2}, {"VEC3", 1, 3}, {"VEC4", 1, 4},
                             {"MAT2", 2, 2},   {"MAT3", 3, 3}, {"MAT4", 4, 4}};

/// Copies one element without its padding and returns where the next goes.
std::uint8_t* copy_element(const ElementLayout& layout, const std::uint8_t* from, std::uint8_t* to) {
  const std::size_t column_size = layout.rows * component_size(layout.component);
  for (std::size_t column = 0; column < layout.columns; ++column) {
    std::memcpy(to, from + column * layout.column_stride, column_size);
    to += column_size;
  }
  return to;
}

/// Where the bytes of a bufferView start, and how far apart its elements are.
struct View {
  const std::uint8_t* data;
  std::size_t stride;
};

View view_of(const Document& document, const Json& reference, std::size_t element_size) {
  const Json& view = document.json["bufferViews"][reference["bufferView"].get<std::size_t>()];
  const std::size_t offset = view.value("byteOffset", std::size_t{0}) + reference.value("byteOffset", std::size_t{0});
  const std::size_t stride = view.value("byteStride", std::size_t{0});
  return {document.buffers[view["buffer"].get<std::size_t>()].data() + offset, stride == 0 ? element_size : stride};
}

void apply_sparse(const Document& document, const Json& sparse, const ElementLayout& layout, RawAccessor& raw) {
  const std::size_t packed_size = raw.bytes.size() / std::max<std::size_t>(raw.count, 1);
  const std::size_t count = sparse["count"].get<std::size_t>();
  const auto index_type = static_cast<ComponentType>(sparse["indices"]["componentType"].get<std::uint16_t>());
  const std::size_t index_size = component_size(index_type);
  const View indices = view_of(document, sparse["indices"], index_size);
  const View values = view_of(document, sparse["values"], layout.size);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t index = 0;  // little endian: the low bytes come first
    std::memcpy(&index, indices.data + i * index_size, index_size);
    assert(index < raw.count);
    copy_element(layout, values.data + i * layout.size, raw.bytes.data() + index * packed_size);
  }
}

template <typename T>
void integers_to_floats(const RawAccessor& raw, std::vector<float>& floats) {
  const float scale = raw.normalized ? 1.0F / static_cast<float>(std::numeric_limits<T>::max()) : 1.0F;
  const float least = raw.normalized ? -1.0F : std::numeric_limits<float>::lowest();
  for (std::size_t i = 0; i < floats.size(); ++i) {
    T value;
    std::memcpy(&value, raw.bytes.data() + i * sizeof(T), sizeof(T));
    floats[i] = std::max(static_cast<float>(value) * scale, least);
  }
}

template <typename T>
Bytes floats_to_integers(const std::vector<float>& floats, bool normalized) {
  Bytes bytes(floats.size() * sizeof(T));
  const double scale = normalized ? static_cast<double>(std::numeric_limits<T>::max()) : 1.0;
  const double least = normalized && std::numeric_limits<T>::is_signed ? -scale : std::numeric_limits<T>::lowest();
  for (std::size_t i = 0; i < floats.size(); ++i) {
    const double wanted = std::isnan(floats[i]) ? 0.0 : std::round(static_cast<double>(floats[i]) * scale);
    const T value = static_cast<T>(std::clamp(wanted, least, static_cast<double>(std::numeric_limits<T>::max())));
    std::memcpy(bytes.data() + i * sizeof(T), &value, sizeof(T));
  }
  return bytes;
}

}  // namespace

std::size_t component_size(ComponentType type) {
  switch (type) {
    case ComponentType::kI8:
    case ComponentType::kU8:
      return 1;
    case ComponentType::kI16:
    case ComponentType::kU16:
      return 2;
    default:
      return 4;
  }
}

std::optional<ElementLayout> element_layout(std::string_view type, std::uint64_t component_type) {
  const bool known =
      (component_type >= 5120 && component_type <= 5123) || component_type == 5125 || component_type == 5126;
  const auto* shape =
      std::find_if(std::begin(kShapes), std::end(kShapes), [&](const Shape& s) { return s.name == type; });
  if (!known || shape == std::end(kShapes)) return std::nullopt;

  ElementLayout layout{static_cast<ComponentType>(component_type), shape->columns, shape->rows, 0, 0};
  const std::size_t column_size = layout.rows * component_size(layout.component);
  layout.column_stride = layout.columns > 1 ? (column_size + 3) / 4 * 4 : column_size;
  layout.size = layout.columns * layout.column_stride;
  return layout;
}

RawAccessor read_accessor(const Document& document, std::size_t accessor) {
  const Json& json = document.json["accessors"][accessor];
  const auto layout = element_layout(json["type"].get<std::string>(), json["componentType"].get<std::uint64_t>());
  assert(layout);

  RawAccessor raw;
  raw.component = layout->component;
  raw.components = static_cast<int>(layout->columns * layout->rows);
  raw.normalized = json.value("normalized", false);
  raw.count = json["count"].get<std::size_t>();
  raw.bytes.resize(raw.count * layout->columns * layout->rows * component_size(layout->component));

  // Pack.
  if (json.contains("bufferView") && raw.count > 0) {
    const View view = view_of(document, json, layout->size);
    if (layout->columns == 1 && view.stride == layout->size) {
      std::memcpy(raw.bytes.data(), view.data, raw.bytes.size());
    } else {
      std::uint8_t* to = raw.bytes.data();
      for (std::size_t i = 0; i < raw.count; ++i) to = copy_element(*layout, view.data + i * view.stride, to);
    }
  }
  if (json.contains("sparse")) apply_sparse(document, json["sparse"], *layout, raw);
  return raw;
}

std::vector<float> as_floats(const RawAccessor& raw) {
  std::vector<float> floats(raw.count * static_cast<std::size_t>(raw.components));
  switch (raw.component) {
    case ComponentType::kI8:
      integers_to_floats<std::int8_t>(raw, floats);
      break;
    case ComponentType::kU8:
      integers_to_floats<std::uint8_t>(raw, floats);
      break;
    case ComponentType::kI16:
      integers_to_floats<std::int16_t>(raw, floats);
      break;
    case ComponentType::kU16:
      integers_to_floats<std::uint16_t>(raw, floats);
      break;
    case ComponentType::kU32:
      integers_to_floats<std::uint32_t>(raw, floats);
      break;
    case ComponentType::kF32:
      if (!floats.empty()) std::memcpy(floats.data(), raw.bytes.data(), raw.bytes.size());
      break;
  }
  return floats;
}

std::vector<std::uint32_t> as_indices(const RawAccessor& raw) {
  assert(raw.component == ComponentType::kU8 || raw.component == ComponentType::kU16 ||
         raw.component == ComponentType::kU32);
  const std::size_t size = component_size(raw.component);
  std::vector<std::uint32_t> indices(raw.count * static_cast<std::size_t>(raw.components));
  for (std::size_t i = 0; i < indices.size(); ++i) std::memcpy(&indices[i], raw.bytes.data() + i * size, size);
  return indices;
}

Bytes encode_floats(const std::vector<float>& floats, ComponentType component, bool normalized) {
  switch (component) {
    case ComponentType::kI8:
      return floats_to_integers<std::int8_t>(floats, normalized);
    case ComponentType::kU8:
      return floats_to_integers<std::uint8_t>(floats, normalized);
    case ComponentType::kI16:
      return floats_to_integers<std::int16_t>(floats, normalized);
    case ComponentType::kU16:
      return floats_to_integers<std::uint16_t>(floats, normalized);
    case ComponentType::kU32:
      return floats_to_integers<std::uint32_t>(floats, normalized);
    case ComponentType::kF32:
      break;
  }
  Bytes bytes(floats.size() * sizeof(float));
  if (!floats.empty()) std::memcpy(bytes.data(), floats.data(), bytes.size());
  return bytes;
}

}  // namespace gltf_radiosity
