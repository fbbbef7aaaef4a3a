// How libFuzzer changes a glTF: mostly within the tree or the binary chunk, with lengths that agree; sometimes bytes
// anywhere. Bytes alone hardly ever get past the first check.
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "tests/fuzz/gltf_parts.h"
#include "tests/fuzz/harness.h"
#include "tests/fuzz/mutate_json.h"

namespace gltf_radiosity::fuzz {
namespace {

constexpr std::array kFloats = {0.0F,
                                -0.0F,
                                1.0F,
                                -1.0F,
                                1e-40F,
                                1e-20F,
                                1e19F,
                                1e30F,
                                std::numeric_limits<float>::max(),
                                std::numeric_limits<float>::infinity(),
                                std::numeric_limits<float>::quiet_NaN()};

/// Bytes as libFuzzer does it, floats that hurt, or a stretch copied elsewhere.
void mutate_binary(Bytes& binary, Random& random) {
  const std::size_t words = binary.size() / sizeof(float);
  if (words == 0 || choose(random, 3) == 0) {
    const std::size_t size = binary.size();
    binary.resize(size + 16);
    binary.resize(LLVMFuzzerMutate(binary.data(), size, binary.size()));
    return;
  }
  std::uint8_t* const to = binary.data() + sizeof(float) * choose(random, words);
  if (choose(random, 2) == 0) {
    std::memcpy(to, &kFloats[choose(random, kFloats.size())], sizeof(float));
    return;
  }
  const std::uint8_t* const from = binary.data() + choose(random, binary.size());
  const auto longest =
      static_cast<std::size_t>(binary.data() + binary.size() - std::max<const std::uint8_t*>(to, from));
  std::memmove(to, from, 1 + choose(random, longest));
}

/// Into `to`, if it fits: the new size, else 0.
std::size_t store(const Bytes& bytes, std::span<std::uint8_t> to) {
  if (bytes.size() > to.size()) return 0;
  std::copy(bytes.begin(), bytes.end(), to.begin());
  return bytes.size();
}

}  // namespace
}  // namespace gltf_radiosity::fuzz

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  using namespace gltf_radiosity::fuzz;
  Random random(seed);
  auto parts = take_apart({data, size});
  if (!parts || choose(random, 16) == 0) return LLVMFuzzerMutate(data, size, max_size);
  if (parts->is_glb && choose(random, 3) == 0) {
    mutate_binary(parts->binary, random);
  } else {
    for (std::size_t changes = 1 + choose(random, 3); changes > 0; --changes) mutate_json(parts->json, random);
  }
  const std::size_t mutated = store(put_together(std::move(*parts)), {data, max_size});
  return mutated > 0 ? mutated : LLVMFuzzerMutate(data, size, max_size);
}

extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* data, std::size_t size, const std::uint8_t* other,
                                                 std::size_t other_size, std::uint8_t* to, std::size_t max_size,
                                                 unsigned seed) {
  using namespace gltf_radiosity::fuzz;
  Random random(seed);
  auto parts = take_apart({data, size});
  auto second = take_apart({other, other_size});
  if (!parts || !second) return 0;
  graft(parts->json, second->json, random);
  return store(put_together(std::move(*parts)), {to, max_size});
}
