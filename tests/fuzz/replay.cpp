// A harness without libFuzzer: every file once as it is, and `runs` times changed, the same way every time.
//
//   fuzz_document RUNS FOLDER-OR-FILE...
//
// For the ordinary test suite under sanitizers: no second compiler, no coverage, seconds. tools/fuzz is the real thing.
#include <sanitizer/common_interface_defs.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/harness.h"

/// Only harnesses that read glTF have one (gltf_mutator.cpp).
extern "C" __attribute__((weak)) std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                                                     std::size_t max_size, unsigned seed);

namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

std::minstd_rand random_bytes;  // LLVMFuzzerMutate has no other way to get at it
std::string current_input;      // nor has what is called on death

std::vector<fs::path> files_in(const fs::path& path) {
  if (fs::is_regular_file(path)) return {path};
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(path)) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

void run(const std::string& name, const Bytes& bytes) {
  current_input = name;
  const Bytes exactly(bytes.begin(), bytes.end());  // no capacity to spare: what reads beyond the end is seen
  LLVMFuzzerTestOneInput(exactly.data(), exactly.size());
}

void run_changed(const fs::path& file, const Bytes& bytes, unsigned seed) {
  Bytes changed = bytes;
  changed.resize(2 * bytes.size() + 256);
  random_bytes.seed(seed);
  const std::size_t size = LLVMFuzzerCustomMutator != nullptr
                               ? LLVMFuzzerCustomMutator(changed.data(), bytes.size(), changed.size(), seed)
                               : LLVMFuzzerMutate(changed.data(), bytes.size(), changed.size());
  changed.resize(size);
  run(file.string() + ", change " + std::to_string(seed), changed);
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size) {
  for (std::size_t changes = 1 + random_bytes() % 4; changes > 0; --changes) {
    if (size < max_size && (size == 0 || random_bytes() % 8 == 0)) ++size;
    if (size > 1 && random_bytes() % 16 == 0) size -= random_bytes() % size;
    data[random_bytes() % size] ^= static_cast<std::uint8_t>(1U << random_bytes() % 8);
    if (random_bytes() % 4 == 0) data[random_bytes() % size] = random_bytes() % 2 == 0 ? 0xff : 0;
  }
  return size;
}

int main(int argument_count, char** arguments) {
  if (argument_count < 3) {
    std::fprintf(stderr, "usage: %s RUNS FOLDER-OR-FILE...\n", arguments[0]);
    return 2;
  }
  __sanitizer_set_death_callback([] { std::fprintf(stderr, "The input was %s\n", current_input.c_str()); });
  const auto runs = static_cast<unsigned>(std::strtoul(arguments[1], nullptr, 10));
  std::size_t count = 0;
  for (int k = 2; k < argument_count; ++k) {
    for (const fs::path& file : files_in(arguments[k])) {
      std::ifstream stream(file, std::ios::binary);
      const Bytes bytes{std::istreambuf_iterator<char>(stream), {}};
      run(file, bytes);
      for (unsigned seed = 1; seed <= runs; ++seed) run_changed(file, bytes, seed);
      count += 1 + runs;
    }
  }
  std::printf("%zu inputs\n", count);
  return count == 0 ? 1 : 0;
}
