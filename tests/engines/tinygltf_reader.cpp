// What tinygltf, with its own Draco support, makes of a file: a line for each corner of each triangle of each mesh,
//
//   x y z red green blue
//
// in the mesh's space, with COLOR_0 times the base colour factor. Exits with 1 if tinygltf has anything to complain
// about.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_ENABLE_DRACO
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

namespace {

/// Rows of an accessor as numbers, normalised integers within [0,1]. [count * components]
std::vector<double> read(const tinygltf::Model& model, int index) {
  const tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(index)];
  const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
  const unsigned char* data =
      model.buffers[static_cast<std::size_t>(view.buffer)].data.data() + view.byteOffset + accessor.byteOffset;
  const auto stride = static_cast<std::size_t>(accessor.ByteStride(view));
  const auto components =
      static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
  const auto size =
      static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType)));
  const double most = !accessor.normalized ? 1.0 : size == 1 ? 255.0 : 65535.0;
  std::vector<double> values;
  for (std::size_t row = 0; row < accessor.count; ++row) {
    for (std::size_t c = 0; c < components; ++c) {
      const unsigned char* at = data + row * stride + c * size;
      float real = 0.0F;
      std::uint32_t whole = 0;
      if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT) {
        std::memcpy(&real, at, size);
      } else {
        std::memcpy(&whole, at, size);
      }
      values.push_back(static_cast<double>(real) + whole / most);
    }
  }
  return values;
}

void print(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
  const std::vector<double> positions = read(model, primitive.attributes.at("POSITION"));
  const std::vector<double> colors = read(model, primitive.attributes.at("COLOR_0"));
  const auto& factor =
      model.materials[static_cast<std::size_t>(primitive.material)].pbrMetallicRoughness.baseColorFactor;
  for (const double index : read(model, primitive.indices)) {
    const auto v = static_cast<std::size_t>(index);
    std::printf("%.9g %.9g %.9g %.9g %.9g %.9g\n", positions[3 * v], positions[3 * v + 1], positions[3 * v + 2],
                colors[4 * v] * factor[0], colors[4 * v + 1] * factor[1], colors[4 * v + 2] * factor[2]);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  tinygltf::Model model;
  tinygltf::TinyGLTF loader;
  std::string error, warning;
  const bool loaded = loader.LoadBinaryFromFile(&model, &error, &warning, argv[1]);
  std::fputs((error + warning).c_str(), stderr);
  if (!loaded || !error.empty()) return 1;
  for (const tinygltf::Mesh& mesh : model.meshes) {
    for (const tinygltf::Primitive& primitive : mesh.primitives) print(model, primitive);
  }
  return 0;
}
