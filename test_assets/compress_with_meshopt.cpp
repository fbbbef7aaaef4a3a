// compress_with_meshopt IN.glb OUT.glb: the same scene with every bufferView compressed by meshoptimizer, in each mode
// and with each filter of EXT_meshopt_compression that suits it.
//
// A program of its own, because Python's standard library has no such encoder. The output needs the extension: the
// buffer that the bufferViews name is a placeholder without data. REQUIRES: one buffer; bufferViews are not shared.
#include <meshoptimizer.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "test_assets/write_glb.h"

namespace {

using Json = nlohmann::ordered_json;
using Bytes = std::vector<unsigned char>;

constexpr int kFloat = 5126;
constexpr const char* kExtension = "EXT_meshopt_compression";

struct Scene {
  Json json;
  Bytes binary;
};

Scene read_glb(const char* file) {
  std::ifstream stream(file, std::ios::binary);
  const Bytes bytes{std::istreambuf_iterator<char>(stream), {}};
  std::uint32_t json_size = 0;
  std::memcpy(&json_size, bytes.data() + 12, sizeof json_size);
  const auto text = bytes.begin() + 20;
  return {Json::parse(text, text + json_size), Bytes(text + json_size + 8, bytes.end())};
}

/// What an accessor is for: an attribute's name, "indices", "rotation", or nothing.
std::vector<std::string> uses_of_accessors(const Json& json) {
  std::vector<std::string> uses(json["accessors"].size());
  for (const Json& mesh : json["meshes"]) {
    for (const Json& primitive : mesh["primitives"]) {
      for (const auto& [name, accessor] : primitive["attributes"].items()) uses[accessor.get<std::size_t>()] = name;
      if (primitive.contains("indices")) uses[primitive["indices"].get<std::size_t>()] = "indices";
    }
  }
  for (const Json& animation : json.value("animations", Json::array())) {
    for (const Json& channel : animation["channels"]) {
      if (channel["target"]["path"] != "rotation") continue;
      uses[animation["samplers"][channel["sampler"].get<std::size_t>()]["output"].get<std::size_t>()] = "rotation";
    }
  }
  return uses;
}

/// One bufferView's decoded layout and its compressed bytes.
struct Compressed {
  std::string mode = "ATTRIBUTES", filter = "NONE";
  std::size_t count = 0, stride = 0;
  Bytes bytes;
};

std::vector<float> floats_of(const unsigned char* from, std::size_t count) {
  std::vector<float> floats(count);
  std::memcpy(floats.data(), from, count * sizeof(float));
  return floats;
}

Bytes encode_vertices(const Bytes& rows, std::size_t count, std::size_t stride) {
  Bytes bytes(meshopt_encodeVertexBufferBound(count, stride));
  bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), rows.data(), count, stride));
  return bytes;
}

/// Unit vectors as four signed bytes, or quaternions as four signed 16-bit numbers: what the filters decode to.
Compressed compress_unit(Json& accessor, const unsigned char* from, bool rotation) {
  const auto count = accessor["count"].get<std::size_t>();
  const std::size_t width = rotation ? 4 : 3;
  const std::vector<float> values = floats_of(from, count * width);
  std::vector<float> rows(count * 4, 1.0F);
  for (std::size_t i = 0; i < count * width; ++i) rows[i / width * 4 + i % width] = values[i];
  Compressed result;
  result.count = count;
  result.stride = rotation ? 8 : 4;
  Bytes encoded(count * result.stride);
  if (rotation) {
    meshopt_encodeFilterQuat(encoded.data(), count, result.stride, 16, rows.data());
  } else {
    meshopt_encodeFilterOct(encoded.data(), count, result.stride, 8, rows.data());
  }
  result.filter = rotation ? "QUATERNION" : "OCTAHEDRAL";
  result.bytes = encode_vertices(encoded, count, result.stride);
  accessor["componentType"] = rotation ? 5122 : 5120;
  accessor["normalized"] = true;
  return result;
}

Compressed compress_floats(const unsigned char* from, std::size_t count, std::size_t stride) {
  const std::vector<float> values = floats_of(from, count * stride / sizeof(float));
  Bytes encoded(count * stride);
  meshopt_encodeFilterExp(encoded.data(), count, stride, 16, values.data());
  return {"ATTRIBUTES", "EXPONENTIAL", count, stride, encode_vertices(encoded, count, stride)};
}

/// Indices of 16 bits: lists of triangles whole, every other one as a sequence.
Compressed compress_indices(const unsigned char* from, std::size_t count, bool triangles) {
  std::vector<unsigned> indices(count);
  for (std::size_t i = 0; i < count; ++i) indices[i] = from[2 * i] + 256U * from[2 * i + 1];
  Compressed result{triangles ? "TRIANGLES" : "INDICES", "NONE", count, 2, {}};
  result.bytes.resize(triangles ? meshopt_encodeIndexBufferBound(count, 65536)
                                : meshopt_encodeIndexSequenceBound(count, 65536));
  result.bytes.resize(
      triangles ? meshopt_encodeIndexBuffer(result.bytes.data(), result.bytes.size(), indices.data(), count)
                : meshopt_encodeIndexSequence(result.bytes.data(), result.bytes.size(), indices.data(), count));
  return result;
}

Compressed compress(const Scene& scene, Json& accessor, const std::string& use, bool as_triangles) {
  const Json& view = scene.json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  const unsigned char* from = scene.binary.data() + view.value("byteOffset", std::size_t{0});
  const auto count = accessor["count"].get<std::size_t>();
  const std::size_t stride = view["byteLength"].get<std::size_t>() / count;
  if (use == "indices") return compress_indices(from, count, as_triangles);
  if (use == "NORMAL" || use == "rotation") return compress_unit(accessor, from, use == "rotation");
  if (use == "POSITION" || use == "WEIGHTS_0") return compress_floats(from, count, stride);
  return {"ATTRIBUTES", "NONE", count, stride, encode_vertices(Bytes(from, from + count * stride), count, stride)};
}

void declare(Json& json, const char* extension) {
  json["extensionsUsed"].push_back(extension);
  json["extensionsRequired"].push_back(extension);
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count != 3) {
    std::cerr << "usage: compress_with_meshopt IN.glb OUT.glb\n";
    return 2;
  }
  const Scene source = read_glb(arguments[1]);
  Json json = source.json;
  const std::vector<std::string> uses = uses_of_accessors(json);
  std::string binary;
  std::size_t decoded_size = 0;
  bool as_triangles = false;
  for (std::size_t i = 0; i < uses.size(); ++i) {
    if (uses[i] == "indices") as_triangles = !as_triangles;
    const Compressed compressed = compress(source, json["accessors"][i], uses[i], as_triangles);
    Json& view = json["bufferViews"][json["accessors"][i]["bufferView"].get<std::size_t>()];
    const bool vertices = view.value("target", 0) == 34962;
    view["buffer"] = 1;
    view["byteOffset"] = decoded_size;
    view["byteLength"] = compressed.count * compressed.stride;
    if (vertices) view["byteStride"] = compressed.stride;
    view["extensions"][kExtension] = {{"buffer", 0},
                                      {"byteOffset", binary.size()},
                                      {"byteLength", compressed.bytes.size()},
                                      {"byteStride", compressed.stride},
                                      {"count", compressed.count},
                                      {"mode", compressed.mode},
                                      {"filter", compressed.filter}};
    binary.append(compressed.bytes.begin(), compressed.bytes.end());
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    decoded_size += (compressed.count * compressed.stride + 3) / 4 * 4;
  }
  json["buffers"] = {{{"name", "compressed"}, {"byteLength", binary.size()}},
                     {{"byteLength", decoded_size}, {"extensions", {{kExtension, {{"fallback", true}}}}}}};
  declare(json, kExtension);
  declare(json, "KHR_mesh_quantization");
  return test_assets::write_glb(arguments[2], json, binary) ? 0 : 1;
}
