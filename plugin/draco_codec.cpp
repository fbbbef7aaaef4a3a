#include "plugin/draco_codec.h"

#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>
#include <draco/metadata/metadata_decoder.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "plugin/accessor_view.h"
#include "plugin/append_accessor.h"
#include "plugin/check_document.h"
#include "plugin/child_trial.h"
#include "plugin/used_extensions.h"

namespace gltf_radiosity {
namespace {

constexpr std::uint64_t kIndices = std::numeric_limits<std::uint64_t>::max();  ///< stands for a blob's triangles

/// What an accessor was filled with: an attribute (its unique id) of the blob in a bufferView.
struct Source {
  std::uint64_t view = 0, id = 0;
  bool operator==(const Source&) const = default;
};

std::span<const std::uint8_t> blob_in(const Document& document, std::size_t view_index) {
  const Json& view = document.json["bufferViews"][view_index];
  return std::span(document.buffers[view["buffer"].get<std::size_t>()])
      .subspan(view.value("byteOffset", std::size_t{0}), view["byteLength"].get<std::size_t>());
}

template <typename T>
bool copy_values(const draco::Mesh& mesh, const draco::PointAttribute& attribute, std::size_t stride, Bytes& bytes) {
  const auto components = static_cast<std::int8_t>(attribute.num_components());
  for (std::uint32_t point = 0; point < mesh.num_points(); ++point) {
    const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(point));
    T converted[4] = {};
    if (value.value() >= attribute.size() || !attribute.ConvertValue<T>(value, components, converted)) return false;
    std::memcpy(bytes.data() + point * stride, converted, sizeof(T) * static_cast<std::size_t>(components));
  }
  return true;
}

/// The faces and points that a blob says it holds, which its accessors repeat; none where it cannot be read. (Formats
/// from 2.2 on, since 2018; earlier ones say the same elsewhere.)
struct Claim {
  std::uint32_t faces = 0, points = 0;
};
std::optional<Claim> claim_of(std::span<const std::uint8_t> blob) {
  constexpr std::uint16_t kBitstream22 = DRACO_BITSTREAM_VERSION(2, 2);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(blob.data()), blob.size());
  draco::DracoHeader header{};
  if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok()) return std::nullopt;
  const auto bitstream =
      static_cast<std::uint16_t>(DRACO_BITSTREAM_VERSION(header.version_major, header.version_minor));
  if (bitstream < kBitstream22) return std::nullopt;
  buffer.set_bitstream_version(bitstream);
  if ((header.flags & METADATA_FLAG_MASK) != 0) {
    draco::GeometryMetadata skipped;
    if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &skipped)) return std::nullopt;
  }
  Claim claim;
  if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING) {
    const bool read = draco::DecodeVarint(&claim.faces, &buffer) && draco::DecodeVarint(&claim.points, &buffer);
    return read ? std::optional(claim) : std::nullopt;
  }
  std::uint8_t traversal = 0;
  const bool read = buffer.Decode(&traversal) && draco::DecodeVarint(&claim.points, &buffer) &&
                    draco::DecodeVarint(&claim.faces, &buffer);
  return read ? std::optional(claim) : std::nullopt;
}

/// Fills accessors of one document from Draco blobs.
class DracoDecoder {
 public:
  explicit DracoDecoder(Document& document) : document_(document) {}

  /// `primitive` has the extension. Leaves it with plain accessors.
  Result<Done> decode(Json& primitive, const std::string& place) {
    const Json extension = primitive["extensions"][kDracoExtension];
    const auto view = extension["bufferView"].get<std::uint64_t>();
    if (primitive.value("mode", 4) != 4) return bad_input(place, "Draco is only supported for triangle lists");
    if (!primitive.contains("indices")) return bad_input(place, "is compressed with Draco but has no indices");

    if (!has_data(primitive, extension, view)) {
      if (auto fits = check_claim(primitive, blob_in(document_, view), place); !fits) return fits;
      auto mesh = decode_foreign_draco_blob(blob_in(document_, view), place);
      if (!mesh) return mesh.error();
      if (auto filled = fill_indices(primitive, **mesh, view, place); !filled) return filled.error();
      for (const auto& [name, id] : extension["attributes"].items()) {
        const Source source{view, id.get<std::uint64_t>()};
        if (auto filled = fill_attribute(primitive["attributes"][name], **mesh, source, place); !filled) {
          return filled.error();
        }
      }
    }
    remove_extension(primitive, kDracoExtension);
    return Done{};
  }

  /// Adds the decoded data to the document.
  void finish() {
    if (bytes_.empty()) return;
    document_.json["buffers"].push_back({{"byteLength", bytes_.size()}});
    document_.buffers.push_back(std::move(bytes_));

    // Bounds are those of the values before compression: quantisation has moved them.
    for (const auto& [index, source] : filled_) {
      Json& accessor = document_.json["accessors"][index];
      const bool bounded = accessor.contains("min") || accessor.contains("max");
      if (bounded && accessor["count"] != 0) set_bounds(read_accessor(document_, index), accessor);
    }
  }

 private:
  /// Whether every accessor has plain data already: a fallback, or the same blob decoded for another primitive.
  bool has_data(const Json& primitive, const Json& extension, std::uint64_t view) const {
    const auto plain = [&](const Json& accessor, std::uint64_t id) {
      const auto filled = filled_.find(accessor.get<std::size_t>());
      if (filled != filled_.end()) return filled->second == Source{view, id};
      return document_.json["accessors"][accessor.get<std::size_t>()].contains("bufferView");
    };
    bool all = plain(primitive["indices"], kIndices);
    for (const auto& [name, id] : extension["attributes"].items()) {
      all = all && plain(primitive["attributes"][name], id.get<std::uint64_t>());
    }
    return all;
  }

  /// Draco takes memory for what its header says: that has to be what the accessors say, and to fit.
  Result<Done> check_claim(const Json& primitive, std::span<const std::uint8_t> blob, const std::string& place) {
    constexpr std::uint64_t kBytesPerFace = 160, kBytesPerPoint = 64;
    const Json& accessors = document_.json["accessors"];
    const auto count_of = [&accessors](const Json& accessor) {
      return accessors[accessor.get<std::size_t>()]["count"].get<std::uint64_t>();
    };
    std::uint64_t faces = count_of(primitive["indices"]) / 3, points = 0;
    for (const auto& [name, accessor] : primitive["attributes"].items()) points = std::max(points, count_of(accessor));
    if (const std::optional<Claim> claim = claim_of(blob)) {
      if (claim->faces != faces) {
        return bad_input(place, fmt::format("Draco holds {} indices where the accessor says {}",
                                            std::uint64_t{claim->faces} * 3, count_of(primitive["indices"])));
      }
      points = std::max<std::uint64_t>(points, claim->points);
    }
    auto fits = document_.memory->check(faces, kBytesPerFace, place, "triangles");
    return fits ? document_.memory->check(points, kBytesPerPoint, place, "vertices") : fits;
  }

  /// Makes `reference` an accessor that reads `data`.
  Result<Done> attach(Json& reference, const Source& source, const Bytes& data, std::size_t stride, int target) {
    // An accessor that holds another blob's data already is cloned.
    auto index = reference.get<std::size_t>();
    Json& accessors = document_.json["accessors"];
    if (const auto filled = filled_.find(index); filled != filled_.end()) {
      if (filled->second == source) return Done{};
      accessors.push_back(Json(accessors[index]));
      index = accessors.size() - 1;
      reference = index;
    }
    filled_[index] = source;

    if (auto fits = document_.memory->reserve(data.size(), 2, "", "bytes of decoded triangles"); !fits) return fits;
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    Json view = {
        {"buffer", document_.json["buffers"].size()}, {"byteOffset", bytes_.size()}, {"byteLength", data.size()}};
    if (stride != 0) view["byteStride"] = stride;
    view["target"] = target;
    bytes_.insert(bytes_.end(), data.begin(), data.end());
    document_.json["bufferViews"].push_back(std::move(view));
    accessors[index].erase("byteOffset");
    accessors[index].erase("sparse");
    accessors[index]["bufferView"] = document_.json["bufferViews"].size() - 1;
    return Done{};
  }

  Result<Done> fill_indices(Json& primitive, const draco::Mesh& mesh, std::uint64_t view, const std::string& place) {
    const Json& accessor = document_.json["accessors"][primitive["indices"].get<std::size_t>()];
    const std::uint64_t count = std::uint64_t{mesh.num_faces()} * 3;
    if (count != accessor["count"].get<std::uint64_t>()) {
      return bad_input(place, fmt::format("Draco holds {} indices where the accessor says {}", count,
                                          accessor["count"].get<std::uint64_t>()));
    }
    const std::size_t size = component_size(static_cast<ComponentType>(accessor["componentType"].get<std::uint16_t>()));
    const std::uint64_t limit = std::min<std::uint64_t>(mesh.num_points(), std::uint64_t{1} << (8 * size));
    Bytes data(count * size);
    std::uint8_t* to = data.data();
    for (std::uint32_t face = 0; face < mesh.num_faces(); ++face) {
      for (const draco::PointIndex& point : mesh.face(draco::FaceIndex(face))) {
        const std::uint32_t index = point.value();
        if (index >= limit) return bad_input(place, fmt::format("index {} is beyond {} vertices", index, limit));
        std::memcpy(to, &index, size);  // little endian: the low bytes come first
        to += size;
      }
    }
    return attach(primitive["indices"], {view, kIndices}, data, 0, 34963);
  }

  Result<Done> fill_attribute(Json& reference, const draco::Mesh& mesh, const Source& source,
                              const std::string& place) {
    const auto index = reference.get<std::size_t>();
    const Json& accessor = document_.json["accessors"][index];
    const draco::PointAttribute* attribute =
        source.id > 0xffffffffU ? nullptr : mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(source.id));
    if (attribute == nullptr) return bad_input(place, fmt::format("Draco holds no attribute {}", source.id));
    const auto layout =
        element_layout(accessor["type"].get<std::string>(), accessor["componentType"].get<std::uint64_t>());
    if (layout->columns != 1 || layout->rows != static_cast<std::size_t>(attribute->num_components())) {
      return bad_input(place, fmt::format("Draco attribute {} has {} components, accessors[{}] another number",
                                          source.id, attribute->num_components(), index));
    }
    if (accessor["count"].get<std::uint64_t>() != mesh.num_points()) {
      return bad_input(place, fmt::format("Draco holds {} vertices where accessors[{}] says {}", mesh.num_points(),
                                          index, accessor["count"].get<std::uint64_t>()));
    }

    const std::size_t stride = (layout->size + 3) / 4 * 4;
    Bytes data(stride * mesh.num_points());
    if (!copy_draco_values(mesh, *attribute, layout->component, stride, data)) {
      return bad_input(place, fmt::format("Draco attribute {} does not fit accessors[{}]", source.id, index));
    }
    return attach(reference, source, data, stride == layout->size ? 0 : stride, 34962);
  }

  Document& document_;
  std::map<std::size_t, Source> filled_;
  Bytes bytes_;
};

}  // namespace

Result<std::unique_ptr<draco::Mesh>> decode_draco_blob(std::span<const std::uint8_t> blob, const std::string& place) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(blob.data()), blob.size());
  // Draco throws std::bad_alloc or std::length_error on some broken blobs.
  try {
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) return bad_input(place, fmt::format("Draco cannot decode it: {}", decoded.status().error_msg()));
    return std::move(decoded).value();
  } catch (const std::exception&) {
    return bad_input(place, "Draco cannot decode it");
  }
}

Result<std::unique_ptr<draco::Mesh>> decode_foreign_draco_blob(std::span<const std::uint8_t> blob,
                                                               const std::string& place) {
  constexpr std::size_t kBytesPerSecond = std::size_t{1} << 16U;
  const auto seconds = static_cast<unsigned>(1 + blob.size() / kBytesPerSecond);
  switch (try_in_child([&] { static_cast<void>(decode_draco_blob(blob, place)); }, seconds)) {
    case TrialEnd::kCrashed:
      return bad_input(place, "Draco crashes on it");
    case TrialEnd::kTooLong:
      return bad_input(place, fmt::format("Draco takes more than {} s for {} bytes", seconds, blob.size()));
    case TrialEnd::kNoProcess:
      return Error{ErrorCode::kLimit, place, "the system has no process to try Draco in"};
    case TrialEnd::kWell:
      break;
  }
  return decode_draco_blob(blob, place);
}

bool copy_draco_values(const draco::Mesh& mesh, const draco::PointAttribute& attribute, ComponentType component,
                       std::size_t stride, Bytes& bytes) {
  switch (component) {
    case ComponentType::kI8:
      return copy_values<std::int8_t>(mesh, attribute, stride, bytes);
    case ComponentType::kU8:
      return copy_values<std::uint8_t>(mesh, attribute, stride, bytes);
    case ComponentType::kI16:
      return copy_values<std::int16_t>(mesh, attribute, stride, bytes);
    case ComponentType::kU16:
      return copy_values<std::uint16_t>(mesh, attribute, stride, bytes);
    case ComponentType::kU32:
      return copy_values<std::uint32_t>(mesh, attribute, stride, bytes);
    case ComponentType::kF32:
      return copy_values<float>(mesh, attribute, stride, bytes);
  }
  return false;
}

Result<Done> decode_draco(Document& document) {
  DracoDecoder decoder(document);
  bool any = false;
  const std::size_t mesh_count = array_of(document.json, "meshes").size();
  for (std::size_t i = 0; i < mesh_count; ++i) {
    const std::size_t primitive_count = array_of(document.json["meshes"][i], "primitives").size();
    for (std::size_t j = 0; j < primitive_count; ++j) {
      Json& primitive = document.json["meshes"][i]["primitives"][j];
      if (extension_of(primitive, kDracoExtension) == nullptr) continue;
      any = true;
      if (auto decoded = decoder.decode(primitive, place_of_primitive(i, j)); !decoded) return decoded.error();
    }
  }
  if (!any) return Done{};
  decoder.finish();
  forget_extension(document.json, kDracoExtension);
  return Done{};
}

}  // namespace gltf_radiosity
