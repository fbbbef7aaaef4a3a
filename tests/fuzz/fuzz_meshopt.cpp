// A stream of EXT_meshopt_compression in a document that describes it: mode, filter, stride, count (two bytes), stream.
#include <string>

#include "plugin/meshopt_decode.h"
#include "tests/fuzz/harness.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gltf_radiosity;
  constexpr std::size_t kHeaderSize = 5;
  if (size < kHeaderSize) return -1;
  const char* const modes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
  const char* const filters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
  const std::size_t stride = data[2], count = data[3] + 256U * data[4];
  const Json stream = {{"buffer", 0},    {"byteLength", size - kHeaderSize}, {"byteStride", stride},
                       {"count", count}, {"mode", modes[data[0] % 3]},       {"filter", filters[data[1] % 4]}};
  const Json view = {
      {"buffer", 1}, {"byteLength", count * stride}, {"extensions", {{"EXT_meshopt_compression", stream}}}};
  const Json placeholder = {{"byteLength", count * stride},
                            {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}};
  Document document;
  document.json["bufferViews"] = Json::array({view});
  document.json["buffers"] = Json::array({{{"byteLength", size - kHeaderSize}}, placeholder});
  document.buffers = {Bytes(data + kHeaderSize, data + size), Bytes()};
  static_cast<void>(decode_meshopt(document));
  return 0;
}
