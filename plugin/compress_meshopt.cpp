#include "plugin/compress_meshopt.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "core/parallel.h"
#include "plugin/attribute_grid.h"
#include "plugin/compressible_primitives.h"
#include "plugin/meshopt_decode.h"
#include "plugin/used_extensions.h"

namespace gltf_radiosity {
namespace {

/// A compressed bufferView.
struct Stream {
  Bytes bytes;
  std::size_t count = 0, stride = 0;  ///< of the rows it decodes to
  const char* mode = "ATTRIBUTES";
  bool exponential = false;  ///< rows are decoded by the filter EXPONENTIAL
  Json bounds;               ///< of the decoded values: an object with min and max
};

/// The streams of a primitive, in the order of its attributes and morph targets.
struct Streams {
  std::vector<Stream> attributes;
  std::vector<std::vector<Stream>> targets;
  Stream indices;
  ComponentType index_component = ComponentType::kU16;
};

/// Floats rounded to whole multiples of 2^exponent: what the filter takes, 8 bits of exponent above 24 bits of a whole
/// number. `floats` becomes what it gives back. None if they do not fit.
std::optional<std::vector<std::uint32_t>> to_grid(std::vector<float>& floats, int exponent) {
  const bool fits = std::all_of(floats.begin(), floats.end(), [&](float value) { return fits_grid(value, exponent); });
  if (!fits) return std::nullopt;
  std::vector<std::uint32_t> words;
  words.reserve(floats.size());
  for (float& value : floats) {
    const auto steps = static_cast<std::int32_t>(std::nearbyint(std::ldexp(value, -exponent)));
    value = std::ldexp(static_cast<float>(steps), exponent);
    words.push_back((static_cast<std::uint32_t>(exponent) << 24U) | (static_cast<std::uint32_t>(steps) & 0xffffffU));
  }
  return words;
}

/// Rows in their new order, each padded to a multiple of 4 bytes.
Bytes padded(const Bytes& packed, std::size_t count, std::size_t stride) {
  const std::size_t row = packed.size() / count;
  Bytes rows(count * stride);
  for (std::size_t i = 0; i < count; ++i) std::memcpy(rows.data() + i * stride, packed.data() + i * row, row);
  return rows;
}

/// The rows that `new_number` keeps (it is [raw.count]; ~0 drops a row), in their new order.
RawAccessor reordered(const RawAccessor& raw, const std::vector<unsigned>& new_number, std::size_t count) {
  RawAccessor result = raw;
  const std::size_t row = component_size(raw.component) * static_cast<std::size_t>(raw.components);
  result.count = count;
  result.bytes.assign(count * row, 0);
  for (std::size_t i = 0; i < raw.count; ++i) {
    if (new_number[i] == ~0U) continue;
    std::memcpy(result.bytes.data() + new_number[i] * row, raw.bytes.data() + i * row, row);
  }
  return result;
}

Stream encode_rows(const AttributeValues& attribute, const std::vector<unsigned>& new_number, std::size_t count,
                   int position_grid) {
  // Values.
  RawAccessor raw = reordered(attribute.raw, new_number, count);
  Stream stream;
  const auto exponent = attribute_grid(attribute.semantic, position_grid);
  Bytes packed;
  if (raw.component == ComponentType::kF32 && exponent) {
    std::vector<float> floats = as_floats(raw);
    if (const auto words = to_grid(floats, *exponent)) {
      stream.exponential = true;
      packed.resize(words->size() * sizeof(std::uint32_t));
      std::memcpy(packed.data(), words->data(), packed.size());
      raw.bytes = encode_floats(floats, ComponentType::kF32, false);
    }
  }
  stream.bounds = Json::object();
  set_bounds(raw, stream.bounds);
  const Bytes& rows = stream.exponential ? packed : raw.bytes;

  // Bytes.
  stream.count = count;
  stream.stride = (rows.size() / count + 3) / 4 * 4;
  const Bytes aligned = padded(rows, count, stream.stride);
  stream.bytes.resize(meshopt_encodeVertexBufferBound(count, stream.stride));
  stream.bytes.resize(
      meshopt_encodeVertexBuffer(stream.bytes.data(), stream.bytes.size(), aligned.data(), count, stream.stride));
  assert(!stream.bytes.empty());
  return stream;
}

Streams encode(const PrimitiveValues& values, int position_grid) {
  // The order that compresses well, and that graphics cards like.
  const std::size_t index_count = values.triangles.size() * 3, source_count = values.vertex_count();
  std::vector<unsigned> indices(index_count);
  std::memcpy(indices.data(), values.triangles.data(), index_count * sizeof(unsigned));
  meshopt_optimizeVertexCacheStrip(indices.data(), indices.data(), index_count, source_count);
  std::vector<unsigned> new_number(source_count);
  const std::size_t count =
      meshopt_optimizeVertexFetchRemap(new_number.data(), indices.data(), index_count, source_count);
  meshopt_remapIndexBuffer(indices.data(), indices.data(), index_count, new_number.data());

  // Triangles.
  Streams streams;
  streams.index_component = index_type(count);
  streams.indices.mode = "TRIANGLES";
  streams.indices.count = index_count;
  streams.indices.stride = component_size(streams.index_component);
  streams.indices.bytes.resize(meshopt_encodeIndexBufferBound(index_count, count));
  streams.indices.bytes.resize(meshopt_encodeIndexBuffer(streams.indices.bytes.data(), streams.indices.bytes.size(),
                                                         indices.data(), index_count));

  // Vertices.
  const auto encode_all = [&](const std::vector<AttributeValues>& attributes) {
    std::vector<Stream> encoded;
    encoded.reserve(attributes.size());
    for (const AttributeValues& attribute : attributes) {
      encoded.push_back(encode_rows(attribute, new_number, count, position_grid));
    }
    return encoded;
  };
  streams.attributes = encode_all(values.attributes);
  for (const auto& target : values.targets) streams.targets.push_back(encode_all(target));
  return streams;
}

/// Puts streams into the tree.
class MeshoptExporter {
 public:
  MeshoptExporter(Document& document, BufferBuilder& buffer) : document_(document), buffer_(buffer) {}

  void add(const SharedPrimitive& shared, const Streams& streams) {
    // What every primitive that shares it has. The order of vertices follows from the triangles.
    Json primitive = primitive_at(shared.places[0]);
    const Json order = {primitive.value("indices", Json()), primitive.value("mode", 4), shared.position_grid,
                        streams.attributes[0].count, streams.indices.count};
    order_ = order.dump();
    add_vertices(primitive["attributes"], streams.attributes);
    if (primitive.contains("targets")) {
      for (std::size_t i = 0; i < streams.targets.size(); ++i)
        add_vertices(primitive["targets"][i], streams.targets[i]);
    }
    add_indices(primitive, streams);
    if (primitive.contains("mode")) primitive["mode"] = 4;

    // Every one of them.
    for (const SharedPrimitive::Place& place : shared.places) {
      for (const char* key : {"attributes", "targets", "indices", "mode"}) {
        if (primitive.contains(key)) primitive_at(place)[key] = primitive[key];
      }
    }
  }

 private:
  Json& primitive_at(const SharedPrimitive::Place& place) {
    return document_.json["meshes"][place.mesh]["primitives"][place.primitive];
  }

  void add_vertices(Json& attributes, const std::vector<Stream>& streams) {
    std::size_t i = 0;
    for (auto& [semantic, accessor] : attributes.items()) {
      const Stream& stream = streams[i++];
      const auto old = accessor.get<std::size_t>();
      const auto [known, is_new] = added_.try_emplace({old, order_, stream.exponential}, 0);
      if (is_new) known->second = vertex_accessor(old, semantic == "POSITION", stream);
      accessor = known->second;
    }
  }

  std::size_t vertex_accessor(std::size_t like, bool needs_bounds, const Stream& stream) {
    Json accessor = document_.json["accessors"][like];
    accessor["count"] = stream.count;
    if (needs_bounds || accessor.contains("min") || accessor.contains("max")) accessor.update(stream.bounds);
    return append(std::move(accessor), stream, BufferTarget::kVertices);
  }

  void add_indices(Json& primitive, const Streams& streams) {
    const auto old =
        primitive.contains("indices") ? std::optional(primitive["indices"].get<std::size_t>()) : std::nullopt;
    const auto [known, is_new] = added_.try_emplace({old.value_or(~std::size_t{0}), order_, false}, 0);
    if (is_new) {
      Json accessor = old ? document_.json["accessors"][*old] : Json::object();
      for (const char* stale : {"min", "max"}) accessor.erase(stale);
      accessor["componentType"] = static_cast<std::uint16_t>(streams.index_component);
      accessor["count"] = streams.indices.count;
      accessor["type"] = "SCALAR";
      known->second = append(std::move(accessor), streams.indices, BufferTarget::kIndices);
    }
    primitive["indices"] = known->second;
  }

  std::size_t append(Json accessor, const Stream& stream, BufferTarget target) {
    // Where it is decoded to.
    const std::size_t size = stream.count * stream.stride;
    Json view = {
        {"buffer", document_.buffers.size() + 1}, {"byteOffset", buffer_.reserve_decoded(size)}, {"byteLength", size}};
    if (target == BufferTarget::kVertices) view["byteStride"] = stream.stride;
    view["target"] = static_cast<std::uint16_t>(target);

    // Where it lies.
    Json extension = {{"buffer", document_.buffers.size()},
                      {"byteOffset", buffer_.append(stream.bytes)},
                      {"byteLength", stream.bytes.size()},
                      {"byteStride", stream.stride},
                      {"count", stream.count},
                      {"mode", stream.mode}};
    if (stream.exponential) extension["filter"] = "EXPONENTIAL";
    view["extensions"][kMeshoptExtension] = std::move(extension);
    document_.json["bufferViews"].push_back(std::move(view));

    // What it is.
    for (const char* stale : {"byteOffset", "sparse"}) accessor.erase(stale);
    accessor["bufferView"] = document_.json["bufferViews"].size() - 1;
    Json& accessors = document_.json["accessors"];
    accessors.push_back(std::move(accessor));
    return accessors.size() - 1;
  }

  Document& document_;
  BufferBuilder& buffer_;
  std::string order_;  ///< names the order of the vertices of the primitive at hand
  std::map<std::tuple<std::size_t, std::string, bool>, std::size_t> added_;  ///< accessor in an order -> new accessor
};

}  // namespace

void compress_meshopt(Document& document, BufferBuilder& buffer, std::vector<Warning>& warnings,
                      const radiosity::Progress& progress) {
  // Streams.
  meshopt_encodeIndexVersion(1);
  meshopt_encodeVertexVersion(0);
  const std::vector<SharedPrimitive> shared = compressible_primitives(document, warnings);
  std::vector<std::optional<Result<Streams>>> streams(shared.size());
  radiosity::parallel_in_chunks(shared.size(), 8, progress, "compress", [&](std::size_t i) {
    const Result<PrimitiveValues> values = read_values(document, shared[i].places[0]);
    streams[i] = values ? Result<Streams>(encode(*values, shared[i].position_grid)) : Result<Streams>(values.error());
  });

  // Tree.
  MeshoptExporter exporter(document, buffer);
  for (std::size_t i = 0; i < shared.size(); ++i) {
    if (*streams[i]) {
      exporter.add(shared[i], **streams[i]);
    } else {
      for (const auto& place : shared[i].places) warnings.push_back(not_compressed(place, streams[i]->error().message));
    }
    streams[i].reset();
  }
  if (buffer.decoded_size() > 0) require_extension(document.json, kMeshoptExtension);
}

}  // namespace gltf_radiosity
