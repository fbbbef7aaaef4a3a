// Textures and skies: PNG, JPEG, WebP, Radiance HDR.
#include "plugin/hdr_decode.h"
#include "plugin/image_decode.h"
#include "tests/fuzz/harness.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gltf_radiosity;
  const std::span<const std::uint8_t> bytes(data, size);
  static_cast<void>(unsupported_format(bytes));
  static_cast<void>(decode_image(bytes, "image"));
  static_cast<void>(decode_hdr(bytes, "sky"));
  return 0;
}
