#include "tests/plugin/gltf_builder.h"

#include <png.h>

#include <cstring>

#include "plugin/base64.h"

namespace gltf_radiosity {
namespace {

template <typename T>
std::span<const std::uint8_t> bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)};
}

std::size_t append(Json& root, const char* array, Json element) {
  Json& elements = root[array];
  elements.push_back(std::move(element));
  return elements.size() - 1;
}

void append_u32(Bytes& bytes, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

void append_chunk(Bytes& bytes, std::size_t type, std::span<const std::uint8_t> data, std::uint8_t padding) {
  const std::size_t padded = (data.size() + 3) / 4 * 4;
  append_u32(bytes, padded);
  append_u32(bytes, type);
  bytes.insert(bytes.end(), data.begin(), data.end());
  bytes.insert(bytes.end(), padded - data.size(), padding);
}

}  // namespace

GltfBuilder::GltfBuilder() {
  json["asset"] = {{"version", "2.0"}, {"generator", "gltf_builder"}};
  json["scene"] = 0;
  json["scenes"] = Json::array({Json{{"nodes", Json::array()}}});
}

std::size_t GltfBuilder::add_buffer_view(std::span<const std::uint8_t> bytes) {
  buffer_.resize((buffer_.size() + 3) / 4 * 4);
  const std::size_t offset = buffer_.size();
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  return append(json, "bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size()}});
}

std::size_t GltfBuilder::add_accessor(std::span<const std::uint8_t> bytes, int component_type, const std::string& type,
                                      std::size_t count, bool normalized) {
  Json accessor = {
      {"bufferView", add_buffer_view(bytes)}, {"componentType", component_type}, {"count", count}, {"type", type}};
  if (normalized) accessor["normalized"] = true;
  return append(json, "accessors", accessor);
}

std::size_t GltfBuilder::add_accessor(const std::vector<glm::vec2>& values) {
  return add_accessor(bytes_of(values), 5126, "VEC2", values.size());
}
std::size_t GltfBuilder::add_accessor(const std::vector<glm::vec3>& values) {
  return add_accessor(bytes_of(values), 5126, "VEC3", values.size());
}
std::size_t GltfBuilder::add_accessor(const std::vector<glm::vec4>& values) {
  return add_accessor(bytes_of(values), 5126, "VEC4", values.size());
}
std::size_t GltfBuilder::add_indices(const std::vector<std::uint32_t>& values) {
  return add_accessor(bytes_of(values), 5125, "SCALAR", values.size());
}

Json GltfBuilder::primitive(const PrimitiveParts& parts) {
  Json result;
  Json& attributes = result["attributes"] = Json::object();
  if (!parts.positions.empty()) attributes["POSITION"] = add_accessor(parts.positions);
  if (!parts.normals.empty()) attributes["NORMAL"] = add_accessor(parts.normals);
  if (!parts.texcoords.empty()) attributes["TEXCOORD_0"] = add_accessor(parts.texcoords);
  if (!parts.colors.empty()) attributes["COLOR_0"] = add_accessor(parts.colors);
  if (!parts.indices.empty()) result["indices"] = add_indices(parts.indices);
  if (parts.material) result["material"] = *parts.material;
  if (parts.mode != 4) result["mode"] = parts.mode;
  return result;
}

std::size_t GltfBuilder::add_mesh(const PrimitiveParts& parts) { return add_mesh(Json::array({primitive(parts)})); }

std::size_t GltfBuilder::add_mesh(const Json& primitives) {
  return append(json, "meshes", {{"primitives", primitives}});
}

std::size_t GltfBuilder::add_material(const Json& material) { return append(json, "materials", material); }

std::size_t GltfBuilder::add_texture(int width, int height, const std::vector<std::uint8_t>& rgba) {
  const std::size_t view = add_buffer_view(encode_png(width, height, rgba));
  const std::size_t image = append(json, "images", {{"bufferView", view}, {"mimeType", "image/png"}});
  return append(json, "textures", {{"source", image}});
}

std::size_t GltfBuilder::add_node(std::optional<std::size_t> mesh, const Json& more,
                                  std::optional<std::size_t> parent) {
  Json node = more;
  if (mesh) node["mesh"] = *mesh;
  const std::size_t index = append(json, "nodes", node);
  if (parent) {
    json["nodes"][*parent]["children"].push_back(index);
  } else {
    json["scenes"][0]["nodes"].push_back(index);
  }
  return index;
}

std::size_t GltfBuilder::add_light(const Json& light, const Json& more) {
  json["extensionsUsed"] = Json::array({"KHR_lights_punctual"});
  Json& lights = json["extensions"]["KHR_lights_punctual"]["lights"];
  lights.push_back(light);
  Json node = more;
  node["extensions"]["KHR_lights_punctual"]["light"] = lights.size() - 1;
  return add_node(std::nullopt, node);
}

Json GltfBuilder::finished(bool embed) const {
  Json result = json;
  if (buffer_.empty()) return result;
  Json& buffer = result["buffers"][0];
  buffer["byteLength"] = buffer_.size();
  if (embed) buffer["uri"] = "data:application/octet-stream;base64," + encode_base64(buffer_);
  return result;
}

Document GltfBuilder::document() const {
  Document document;
  document.json = finished(false);
  if (!buffer_.empty()) document.buffers.push_back(buffer_);
  return document;
}

Bytes GltfBuilder::glb() const {
  const std::string text = finished(false).dump();
  Bytes chunks;
  append_chunk(chunks, 0x4E4F534A, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, ' ');
  if (!buffer_.empty()) append_chunk(chunks, 0x004E4942, buffer_, 0);

  Bytes result;
  append_u32(result, 0x46546C67);
  append_u32(result, 2);
  append_u32(result, 12 + chunks.size());
  result.insert(result.end(), chunks.begin(), chunks.end());
  return result;
}

std::string GltfBuilder::embedded() const { return finished(true).dump(); }

PrimitiveParts unit_square() {
  PrimitiveParts parts;
  parts.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}};
  parts.normals = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}};
  parts.texcoords = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  parts.indices = {0, 1, 2, 0, 2, 3};
  return parts;
}

Bytes encode_png(int width, int height, const std::vector<std::uint8_t>& rgba) {
  png_image image;
  std::memset(&image, 0, sizeof image);
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGBA;
  png_alloc_size_t size = 0;
  png_image_write_to_memory(&image, nullptr, &size, 0, rgba.data(), 0, nullptr);
  Bytes bytes(size);
  png_image_write_to_memory(&image, bytes.data(), &size, 0, rgba.data(), 0, nullptr);
  bytes.resize(size);
  return bytes;
}

}  // namespace gltf_radiosity
