// A blob of KHR_draco_mesh_compression, and its attributes as every type that an accessor may have.
#include <draco/mesh/mesh.h>

#include "plugin/draco_codec.h"
#include "tests/fuzz/harness.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gltf_radiosity;
  const auto mesh = decode_foreign_draco_blob({data, size}, "blob");
  if (!mesh) return 0;
  for (int i = 0; i < (*mesh)->num_attributes(); ++i) {
    const draco::PointAttribute& attribute = *(*mesh)->attribute(i);
    for (const auto component : {ComponentType::kI8, ComponentType::kU16, ComponentType::kU32, ComponentType::kF32}) {
      const std::size_t stride = static_cast<std::size_t>(attribute.num_components()) * component_size(component);
      Bytes bytes(stride * (*mesh)->num_points());
      copy_draco_values(**mesh, attribute, component, stride, bytes);
    }
  }
  return 0;
}
