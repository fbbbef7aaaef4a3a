// A proof of a baked file that anyone may have made, against itself.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "plugin/verify.h"
#include "tests/fuzz/harness.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gltf_radiosity;
  static const std::string file =
      std::filesystem::temp_directory_path() / ("gltf-radiosity-fuzz-" + std::to_string(::getpid()) + ".glb");
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  VerifyOptions options;
  options.bake.threads = 1;
  options.points = 8;
  options.max_samples = 64;
  const auto report = verify_files(file, file, options);
  std::filesystem::remove(file);
  if (!report && report.error().code == ErrorCode::kInternal) __builtin_trap();
  return 0;
}
