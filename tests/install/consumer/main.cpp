// The smallest program that uses the installed library: one triangle under the default sky.
#include <gltf_radiosity/gltf_radiosity.h>

#include <cstdio>

constexpr std::string_view kTriangle =
    R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}],
  "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";

int main() {
  const auto baked = gltf_radiosity::bake_memory(std::as_bytes(std::span(kTriangle)), {});
  std::puts(baked ? gltf_radiosity::to_json(baked->report).c_str() : baked.error().text().c_str());
  return baked && baked->report.output_triangles > 0 && baked->glb.size() > 36 ? 0 : 1;
}
