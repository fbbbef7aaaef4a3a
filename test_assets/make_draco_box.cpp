// Writes draco_box.glb: a room seen from within, compressed by Draco, and a point light in its middle.
//
// A program of its own, because Python's standard library has no Draco encoder. The box needs nothing but
// KHR_draco_mesh_compression: its accessors have no bufferViews to fall back on.
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "test_assets/write_glb.h"

namespace {

using Json = nlohmann::ordered_json;
using Vector = std::array<float, 3>;

/// Half the room's size, m. Quantisation, relative to the longest side, moves the other ones.
constexpr Vector kHalf{1.0F, 0.95F, 1.1F};
constexpr std::uint32_t kVertexCount = 24;
constexpr std::uint32_t kTriangleCount = 12;

/// Appends one attribute of three floats per vertex and returns its id.
int add_attribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, const std::vector<Vector>& values) {
  draco::GeometryAttribute attribute;
  attribute.Init(type, nullptr, 3, draco::DT_FLOAT32, false, sizeof(Vector), 0);
  const int id = mesh.AddAttribute(attribute, true, kVertexCount);
  for (std::uint32_t vertex = 0; vertex < kVertexCount; ++vertex) {
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(vertex), values[vertex].data());
  }
  return id;
}

/// Six faces of four vertices, each with its own normal, facing inwards.
void fill_box(draco::Mesh& mesh) {
  std::vector<Vector> positions;
  std::vector<Vector> normals;
  mesh.set_num_points(kVertexCount);
  mesh.SetNumFaces(kTriangleCount);
  for (std::uint32_t face = 0; face < 6; ++face) {
    const std::uint32_t axis = face / 2;
    const float side = face % 2 == 0 ? -1.0F : 1.0F;
    for (const auto& [u, v] : {std::array{-1.0F, -1.0F}, {1.0F, -1.0F}, {1.0F, 1.0F}, {-1.0F, 1.0F}}) {
      Vector position{};
      position[axis] = side * kHalf[axis];
      position[(axis + 1) % 3] = u * kHalf[(axis + 1) % 3];
      position[(axis + 2) % 3] =
          -side * v * kHalf[(axis + 2) % 3];  // turns the winding with the side, so that all faces look inwards
      Vector normal{};
      normal[axis] = -side;
      positions.push_back(position);
      normals.push_back(normal);
    }
    const std::uint32_t a = 4 * face;
    using Point = draco::PointIndex;
    mesh.SetFace(draco::FaceIndex(2 * face), {Point(a), Point(a + 1), Point(a + 2)});
    mesh.SetFace(draco::FaceIndex(2 * face + 1), {Point(a), Point(a + 2), Point(a + 3)});
  }
  add_attribute(mesh, draco::GeometryAttribute::POSITION, positions);
  add_attribute(mesh, draco::GeometryAttribute::NORMAL, normals);
}

/// The glTF around `compressed_size` bytes of Draco data that decode to `vertex_count` vertices.
Json describe(std::size_t compressed_size, std::size_t vertex_count) {
  const Vector low{-kHalf[0], -kHalf[1], -kHalf[2]};
  const Json draco = {{"bufferView", 0}, {"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}};
  const Json primitive = {{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}},
                          {"indices", 2},
                          {"material", 0},
                          {"extensions", {{"KHR_draco_mesh_compression", draco}}}};
  const Json light = {{"type", "point"}, {"intensity", 1.0}};
  const Json grey = {{"baseColorFactor", {0.5, 0.5, 0.5, 1.0}}, {"metallicFactor", 0}};
  Json json;
  json["asset"] = {{"version", "2.0"}, {"generator", "gltf-radiosity test_assets"}};
  json["extensionsUsed"] = {"KHR_draco_mesh_compression", "KHR_lights_punctual"};
  json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  json["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({light});
  json["scene"] = 0;
  json["scenes"] = Json::array({{{"nodes", {0, 1}}}});
  json["nodes"] = {{{"name", "box"}, {"mesh", 0}},
                   {{"name", "lamp"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
  json["meshes"] = Json::array({{{"name", "box"}, {"primitives", Json::array({primitive})}}});
  json["materials"] = Json::array({{{"name", "grey"}, {"pbrMetallicRoughness", grey}}});
  json["accessors"] = {
      {{"componentType", 5126}, {"count", vertex_count}, {"type", "VEC3"}, {"min", low}, {"max", kHalf}},
      {{"componentType", 5126}, {"count", vertex_count}, {"type", "VEC3"}},
      {{"componentType", 5123}, {"count", 3 * kTriangleCount}, {"type", "SCALAR"}}};
  json["bufferViews"] = Json::array({{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", compressed_size}}});
  json["buffers"] = Json::array({{{"byteLength", compressed_size}}});
  return json;
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::cerr << "usage: make_draco_box OUT.glb\n";
    return 2;
  }
  draco::Mesh mesh;
  fill_box(mesh);
  draco::ExpertEncoder encoder(mesh);
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  encoder.SetAttributeQuantization(0, 11);
  encoder.SetAttributeQuantization(1, 10);
  encoder.SetTrackEncodedProperties(true);
  draco::EncoderBuffer compressed;
  if (!encoder.EncodeToBuffer(&compressed).ok() || encoder.num_encoded_faces() != kTriangleCount) {
    std::cerr << "make_draco_box: the encoder failed\n";
    return 1;
  }
  const Json json = describe(compressed.size(), encoder.num_encoded_points());
  const std::string binary(compressed.data(), compressed.size());
  return test_assets::write_glb(arguments[1], json, binary) ? 0 : 1;
}
