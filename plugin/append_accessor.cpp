#include "plugin/append_accessor.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>

namespace gltf_radiosity {
namespace {

constexpr std::size_t aligned(std::size_t size) { return (size + 3) / 4 * 4; }

const char* type_name(int components) {
  constexpr const char* kNames[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  assert(components >= 1 && components <= 4);
  return kNames[components - 1];
}

/// Rows as glTF wants them in memory: columns of matrices and rows of vertices padded to multiples of 4 bytes.
Bytes padded_rows(const RawAccessor& raw, const ElementLayout& layout, std::size_t stride) {
  const std::size_t column_size = layout.rows * component_size(layout.component);
  Bytes rows(raw.count * stride);
  const std::uint8_t* from = raw.bytes.data();
  for (std::size_t i = 0; i < raw.count; ++i) {
    for (std::size_t column = 0; column < layout.columns; ++column, from += column_size) {
      std::memcpy(rows.data() + i * stride + column * layout.column_stride, from, column_size);
    }
  }
  return rows;
}

template <typename T>
void set_bounds(const RawAccessor& raw, Json& accessor) {
  const auto components = static_cast<std::size_t>(raw.components);
  Json least = Json::array(), most = Json::array();
  for (std::size_t c = 0; c < components; ++c) {
    T low{}, high{};
    for (std::size_t i = 0; i < raw.count; ++i) {
      T value;
      std::memcpy(&value, raw.bytes.data() + (i * components + c) * sizeof(T), sizeof(T));
      low = i == 0 ? value : std::min(low, value);
      high = i == 0 ? value : std::max(high, value);
    }
    least.push_back(low);
    most.push_back(high);
  }
  accessor["min"] = std::move(least);
  accessor["max"] = std::move(most);
}

}  // namespace

void set_bounds(const RawAccessor& raw, Json& accessor) {
  switch (raw.component) {
    case ComponentType::kI8:
      return set_bounds<std::int8_t>(raw, accessor);
    case ComponentType::kU8:
      return set_bounds<std::uint8_t>(raw, accessor);
    case ComponentType::kI16:
      return set_bounds<std::int16_t>(raw, accessor);
    case ComponentType::kU16:
      return set_bounds<std::uint16_t>(raw, accessor);
    case ComponentType::kU32:
      return set_bounds<std::uint32_t>(raw, accessor);
    case ComponentType::kF32:
      return set_bounds<float>(raw, accessor);
  }
}

ComponentType index_type(std::size_t vertex_count) {
  constexpr std::size_t kMaxVerticesOfU16 = 65535;
  return vertex_count <= kMaxVerticesOfU16 ? ComponentType::kU16 : ComponentType::kU32;
}

RawAccessor index_rows(std::span<const glm::uvec3> triangles, std::size_t vertex_count) {
  RawAccessor raw{index_type(vertex_count), 1, false, triangles.size() * 3, {}};
  const std::size_t size = component_size(raw.component);
  raw.bytes.reserve(raw.count * size);
  for (const glm::uvec3& triangle : triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      for (std::size_t byte = 0; byte < size; ++byte) {
        raw.bytes.push_back(static_cast<std::uint8_t>(triangle[corner] >> (8 * byte)));
      }
    }
  }
  return raw;
}

std::size_t BufferBuilder::append(std::span<const std::uint8_t> bytes) {
  bytes_.resize(aligned(bytes_.size()));
  const std::size_t offset = bytes_.size();
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  return offset;
}

void BufferBuilder::replace(std::size_t offset, std::span<const std::uint8_t> bytes) {
  assert(offset + bytes.size() <= bytes_.size());
  std::copy(bytes.begin(), bytes.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(offset));
}

std::size_t BufferBuilder::reserve_decoded(std::size_t size) {
  const std::size_t offset = aligned(decoded_size_);
  decoded_size_ = offset + size;
  return offset;
}

void move_into(Document& document, BufferBuilder& buffer) {
  assert(buffer.decoded_size() == 0);
  document.json["buffers"].push_back({{"byteLength", buffer.bytes().size()}});
  document.buffers.push_back(buffer.bytes());
  buffer = BufferBuilder();
}

std::size_t append_accessor(Document& document, BufferBuilder& buffer, const RawAccessor& raw, BufferTarget target,
                            Json like, bool bounds) {
  // The bytes.
  const std::string type = like.contains("type") ? like["type"].get<std::string>() : type_name(raw.components);
  const auto layout = element_layout(type, static_cast<std::uint64_t>(raw.component));
  assert(layout && raw.count > 0);
  const bool vertices = target == BufferTarget::kVertices;
  const std::size_t stride = vertices ? aligned(layout->size) : layout->size;
  const bool packed = layout->columns == 1 && stride == layout->size;
  const Bytes rows = packed ? Bytes() : padded_rows(raw, *layout, stride);
  const std::size_t offset = buffer.append(packed ? raw.bytes : rows);

  // The bufferView. (No reference is kept: a new member of an ordered tree moves the others.)
  Json view = {{"buffer", document.buffers.size()}, {"byteOffset", offset}, {"byteLength", raw.count * stride}};
  if (vertices && stride != layout->size) view["byteStride"] = stride;
  view["target"] = static_cast<std::uint16_t>(target);
  document.json["bufferViews"].push_back(std::move(view));

  // The accessor.
  for (const char* stale : {"byteOffset", "sparse", "normalized"}) like.erase(stale);
  like["bufferView"] = document.json["bufferViews"].size() - 1;
  like["componentType"] = static_cast<std::uint16_t>(raw.component);
  if (raw.normalized) like["normalized"] = true;
  like["count"] = raw.count;
  like["type"] = type;
  if (bounds || like.contains("min") || like.contains("max")) set_bounds(raw, like);
  Json& accessors = document.json["accessors"];
  accessors.push_back(std::move(like));
  return accessors.size() - 1;
}

}  // namespace gltf_radiosity
