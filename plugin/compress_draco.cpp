#include "plugin/compress_draco.h"

#include <draco/attributes/geometry_attribute.h>
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/parallel.h"
#include "plugin/attribute_grid.h"
#include "plugin/compressible_primitives.h"
#include "plugin/draco_codec.h"
#include "plugin/used_extensions.h"

namespace gltf_radiosity {
namespace {

/// Between the smallest blob (0) and the fastest decoder (10). A million triangles with seven attributes: 3.2 s and
/// 2.7 MB with 0, 1.0 s and 3.0 MB with 5, 0.4 s and 6.4 MB with 10.
constexpr int kSpeed = 3;
constexpr int kMaxGridBits = 24;  ///< all that a float can hold
constexpr int kNormalBits = 12;   ///< of each of two coordinates on an octahedron

/// A compressed primitive.
struct Blob {
  Bytes bytes;
  std::uint32_t vertex_count = 0, triangle_count = 0;
  std::vector<Json> bounds;  ///< of each attribute as decoded: an object with min and max
};

draco::DataType draco_type(ComponentType component) {
  switch (component) {
    case ComponentType::kI8:
      return draco::DT_INT8;
    case ComponentType::kU8:
      return draco::DT_UINT8;
    case ComponentType::kI16:
      return draco::DT_INT16;
    case ComponentType::kU16:
      return draco::DT_UINT16;
    case ComponentType::kU32:
      return draco::DT_UINT32;
    case ComponentType::kF32:
      break;
  }
  return draco::DT_FLOAT32;
}

draco::GeometryAttribute::Type draco_semantic(const std::string& semantic, ComponentType component) {
  if (semantic == "POSITION") return draco::GeometryAttribute::POSITION;
  if (semantic == "NORMAL") {
    // Draco predicts normals on its octahedron, where integers have never been: it gives back others.
    return component == ComponentType::kF32 ? draco::GeometryAttribute::NORMAL : draco::GeometryAttribute::GENERIC;
  }
  if (semantic.starts_with("TEXCOORD_")) return draco::GeometryAttribute::TEX_COORD;
  if (semantic.starts_with("COLOR_")) return draco::GeometryAttribute::COLOR;
  return draco::GeometryAttribute::GENERIC;
}

/// What Draco makes of floats: origin + range * i / (2^bits - 1) for whole numbers i.
struct Quantisation {
  int bits = 0;
  std::vector<float> origin;  ///< of each component
  float range = 1.0F;
};

/// Colours within [0,1]: white and black must stay.
std::optional<Quantisation> of_colors(const std::vector<float>& values, const RawAccessor& raw, int bits) {
  const bool inside = std::all_of(values.begin(), values.end(), [](float v) { return v >= 0.0F && v <= 1.0F; });
  if (!inside) return std::nullopt;
  return Quantisation{bits, std::vector<float>(static_cast<std::size_t>(raw.components), 0.0F), 1.0F};
}

/// The grid with steps of 2^exponent; none if the values do not fit.
std::optional<Quantisation> of_grid(const std::vector<float>& values, const RawAccessor& raw, int exponent) {
  const auto components = static_cast<std::size_t>(raw.components);
  Quantisation result;
  float steps = 1.0F;
  for (std::size_t c = 0; c < components; ++c) {
    float least = values[c], most = values[c];
    for (std::size_t i = c; i < values.size(); i += components) {
      least = std::min(least, values[i]);
      most = std::max(most, values[i]);
    }
    const float first = std::floor(std::ldexp(least, -exponent));
    result.origin.push_back(std::ldexp(first, exponent));
    steps = std::max(steps, std::ceil(std::ldexp(most, -exponent)) - first);
    if (!fits_grid(least, exponent) || !fits_grid(most, exponent)) return std::nullopt;
  }
  result.bits = std::max(1, static_cast<int>(std::ceil(std::log2(steps + 1.0F))));
  if (result.bits > kMaxGridBits) return std::nullopt;
  result.range = std::ldexp(static_cast<float>((1U << static_cast<unsigned>(result.bits)) - 1), exponent);
  return result;
}

std::optional<Quantisation> quantisation_of(const AttributeValues& attribute, int grid, int color_bits) {
  const auto exponent = attribute_grid(attribute.semantic, grid);
  if (attribute.raw.component != ComponentType::kF32 || !exponent) return std::nullopt;
  const std::vector<float> values = as_floats(attribute.raw);
  if (attribute.semantic == "NORMAL") return Quantisation{kNormalBits, {0.0F}, 1.0F};
  if (attribute.semantic.starts_with("COLOR_")) return of_colors(values, attribute.raw, color_bits);
  return of_grid(values, attribute.raw, *exponent);
}

/// Draco keeps options as texts, and would write these with six decimals.
draco::Options options_of(const Quantisation& quantisation) {
  draco::Options options;
  std::string origin;
  for (const float value : quantisation.origin) origin += fmt::format("{} ", value);
  options.SetInt("quantization_bits", quantisation.bits);
  options.SetString("quantization_origin", origin);
  options.SetString("quantization_range", fmt::format("{}", quantisation.range));
  return options;
}

/// The primitive as Draco takes it; attributes have the ids 0, 1, 2, ...
std::unique_ptr<draco::Mesh> mesh_of(const PrimitiveValues& values, bool keep_order) {
  auto result = std::make_unique<draco::Mesh>();
  draco::Mesh& mesh = *result;
  mesh.set_num_points(static_cast<std::uint32_t>(values.vertex_count()));
  for (std::uint32_t i = 0; i < values.attributes.size(); ++i) {
    const RawAccessor& raw = values.attributes[i].raw;
    const std::size_t row = component_size(raw.component) * static_cast<std::size_t>(raw.components);
    draco::GeometryAttribute attribute;
    attribute.Init(draco_semantic(values.attributes[i].semantic, raw.component), nullptr,
                   static_cast<std::uint8_t>(raw.components), draco_type(raw.component), raw.normalized,
                   static_cast<std::int64_t>(row), 0);
    const int id = mesh.AddAttribute(attribute, true, static_cast<std::uint32_t>(raw.count));
    mesh.attribute(id)->buffer()->Write(0, raw.bytes.data(), raw.bytes.size());
    mesh.attribute(id)->set_unique_id(i);
  }
  mesh.SetNumFaces(values.triangles.size());
  for (std::uint32_t t = 0; t < values.triangles.size(); ++t) {
    const glm::uvec3& corners = values.triangles[t];
    mesh.SetFace(draco::FaceIndex(t),
                 {draco::PointIndex(corners.x), draco::PointIndex(corners.y), draco::PointIndex(corners.z)});
  }
  // Seams are found by equal positions.
  if (!keep_order) {
    mesh.DeduplicateAttributeValues();
    mesh.DeduplicatePointIds();
  }
  return result;
}

/// Decodes what was encoded: quantisation has moved the bounds, and the encoder decides how many vertices there are.
Result<Blob> checked(Bytes bytes, const PrimitiveValues& values, bool keeps_order) {
  const auto mesh = decode_draco_blob(bytes, "");
  if (!mesh) return mesh.error();
  Blob blob{std::move(bytes), (*mesh)->num_points(), (*mesh)->num_faces(), {}};
  const bool as_many = blob.vertex_count == values.vertex_count() && blob.triangle_count == values.triangles.size();
  if (blob.triangle_count == 0 || (keeps_order && !as_many)) return bad_input("", "Draco cannot encode it");
  for (std::uint32_t i = 0; i < values.attributes.size(); ++i) {
    RawAccessor raw = values.attributes[i].raw;
    const std::size_t row = component_size(raw.component) * static_cast<std::size_t>(raw.components);
    raw.count = blob.vertex_count;
    raw.bytes.resize(raw.count * row);
    const draco::PointAttribute* attribute = (*mesh)->GetAttributeByUniqueId(i);
    if (attribute == nullptr || !copy_draco_values(**mesh, *attribute, raw.component, row, raw.bytes)) {
      return bad_input("", fmt::format("Draco does not give {} back", values.attributes[i].semantic));
    }
    set_bounds(raw, blob.bounds.emplace_back(Json::object()));
  }
  return blob;
}

Result<Blob> encode(const PrimitiveValues& values, int grid, int color_bits) {
  const bool keep_order = !values.targets.empty();
  const std::unique_ptr<draco::Mesh> mesh = mesh_of(values, keep_order);
  draco::EncoderOptions options = draco::EncoderOptions::CreateDefaultOptions();
  options.SetSpeed(kSpeed, kSpeed);
  for (std::size_t i = 0; i < values.attributes.size(); ++i) {
    const auto quantisation = quantisation_of(values.attributes[i], grid, color_bits);
    if (quantisation) options.SetAttributeOptions(static_cast<std::int32_t>(i), options_of(*quantisation));
  }
  draco::ExpertEncoder encoder(*mesh);
  encoder.Reset(options);
  encoder.SetEncodingMethod(keep_order ? draco::MESH_SEQUENTIAL_ENCODING : draco::MESH_EDGEBREAKER_ENCODING);
  draco::EncoderBuffer encoded;
  const draco::Status status = encoder.EncodeToBuffer(&encoded);
  if (!status.ok()) return bad_input("", fmt::format("Draco cannot encode it: {}", status.error_msg()));
  return checked(Bytes(encoded.data(), encoded.data() + encoded.size()), values, keep_order);
}

/// Puts blobs into the tree.
class DracoExporter {
 public:
  DracoExporter(Document& document, BufferBuilder& buffer) : document_(document), buffer_(buffer) {}

  void add(const SharedPrimitive& shared, const Blob& blob) {
    // The blob, and what every primitive that shares it has.
    Json& views = document_.json["bufferViews"];
    const std::size_t offset = buffer_.append(blob.bytes);
    views.push_back({{"buffer", document_.buffers.size()}, {"byteOffset", offset}, {"byteLength", blob.bytes.size()}});
    Json extension = {{"bufferView", views.size() - 1}, {"attributes", Json::object()}};
    Json attributes = primitive_at(shared.places[0])["attributes"];
    std::size_t id = 0;
    for (auto& [semantic, accessor] : attributes.items()) {
      accessor = vertex_accessor(accessor.get<std::size_t>(), semantic == "POSITION", blob, blob.bounds[id]);
      extension["attributes"][semantic] = id++;
    }
    const std::size_t indices = index_accessor(primitive_at(shared.places[0]), blob);

    // Every one of them.
    for (const SharedPrimitive::Place& place : shared.places) {
      Json& primitive = primitive_at(place);
      primitive["attributes"] = attributes;
      primitive["indices"] = indices;
      if (primitive.contains("mode")) primitive["mode"] = 4;
      primitive["extensions"][kDracoExtension] = extension;
    }
  }

 private:
  Json& primitive_at(const SharedPrimitive::Place& place) {
    return document_.json["meshes"][place.mesh]["primitives"][place.primitive];
  }

  std::size_t append(Json accessor) {
    for (const char* stale : {"bufferView", "byteOffset", "sparse"}) accessor.erase(stale);
    Json& accessors = document_.json["accessors"];
    accessors.push_back(std::move(accessor));
    return accessors.size() - 1;
  }

  std::size_t vertex_accessor(std::size_t like, bool needs_bounds, const Blob& blob, const Json& bounds) {
    Json accessor = document_.json["accessors"][like];
    accessor["count"] = blob.vertex_count;
    if (needs_bounds || accessor.contains("min") || accessor.contains("max")) accessor.update(bounds);
    return append(std::move(accessor));
  }

  std::size_t index_accessor(const Json& primitive, const Blob& blob) {
    Json accessor = Json::object();
    if (primitive.contains("indices")) {
      accessor = document_.json["accessors"][primitive["indices"].get<std::size_t>()];
    }
    for (const char* stale : {"min", "max"}) accessor.erase(stale);
    accessor["componentType"] = static_cast<std::uint16_t>(index_type(blob.vertex_count));
    accessor["count"] = std::uint64_t{blob.triangle_count} * 3;
    accessor["type"] = "SCALAR";
    return append(std::move(accessor));
  }

  Document& document_;
  BufferBuilder& buffer_;
};

}  // namespace

void compress_draco(Document& document, BufferBuilder& buffer, int color_bits, std::vector<Warning>& warnings,
                    const radiosity::Progress& progress) {
  // Blobs.
  const std::vector<SharedPrimitive> shared = compressible_primitives(document, warnings);
  std::vector<std::optional<Result<Blob>>> blobs(shared.size());
  radiosity::parallel_in_chunks(shared.size(), 8, progress, "compress", [&](std::size_t i) {
    const Result<PrimitiveValues> values = read_values(document, shared[i].places[0]);
    blobs[i] = values ? encode(*values, shared[i].position_grid, color_bits) : Result<Blob>(values.error());
  });

  // Tree.
  DracoExporter exporter(document, buffer);
  bool any = false;
  for (std::size_t i = 0; i < shared.size(); ++i) {
    if (*blobs[i]) {
      exporter.add(shared[i], **blobs[i]);
      any = true;
    } else {
      for (const auto& place : shared[i].places) warnings.push_back(not_compressed(place, blobs[i]->error().message));
    }
    blobs[i].reset();
  }
  if (any) require_extension(document.json, kDracoExtension);
}

}  // namespace gltf_radiosity
