// A glTF that anyone may have made: reading, and everything that a bake or a proof takes out of it.
#include "plugin/document.h"
#include "plugin/firewall.h"
#include "plugin/import_scene.h"
#include "tests/fuzz/harness.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gltf_radiosity;
  const auto read = behind_firewall([&] {
    return read_document({data, size}, {}, {.max_memory = std::uint64_t{256} << 20U});
  });
  if (!read) return read.error().code == ErrorCode::kInternal ? (__builtin_trap(), 0) : 0;
  std::vector<Warning> warnings;
  const auto imported = behind_firewall([&] { return import_scene(*read, {}, warnings); });
  if (!imported && imported.error().code == ErrorCode::kInternal) __builtin_trap();
  const auto displayed = behind_firewall([&] { return import_displayed(*read, std::nullopt, warnings); });
  if (!displayed && displayed.error().code == ErrorCode::kInternal) __builtin_trap();
  return 0;
}
