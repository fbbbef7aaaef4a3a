// A whole bake in memory, as small as options allow. The input chooses among the options that change what is written,
// and what is written is read again.
#include <numeric>

#include "plugin/document.h"
#include "plugin/gltf_radiosity.h"
#include "tests/fuzz/harness.h"

namespace {

using namespace gltf_radiosity;

/// The same input has the same options. Each bit of `choice` decides one.
Options options_of(unsigned choice) {
  const auto bit = [choice](unsigned k) { return (choice >> k & 1U) != 0; };
  Options options;
  options.threads = 1;
  options.hemicube = 2;
  options.max_patches = 16;
  options.max_memory = std::uint64_t{64} << 20U;
  options.residual = 0.5;
  options.refine = bit(0) ? Refine::kNone : bit(1) ? Refine::kUniform : Refine::kAdaptive;
  options.max_vertices = 100;
  options.max_error = 0.5;
  options.patch_size = 1e9;  // cuts nothing: the input's own triangles are few
  options.simplify = bit(2);
  options.visibility = bit(3) || bit(13) ? VisibilityMethod::kRays : VisibilityMethod::kRaster;
  options.solver = bit(4) ? SolverMethod::kProgressive : SolverMethod::kGathering;
  options.two_sided = bit(5) ? TwoSided::kLit : TwoSided::kFront;
  options.meshopt = bit(6);
  options.draco_bits = bit(7) && !bit(6) ? 12 : 0;
  options.target = bit(8) ? Target::kKeep : Target::kUnlit;
  options.strip_lights = bit(9);
  options.fit = bit(12) ? FitMethod::kLeastSquares : FitMethod::kInterpolate;
  if (bit(10)) options.color_type = ColorType::kU8;
  if (bit(11)) options.scale_to_factor = true;
  return options;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const unsigned choice = std::accumulate(data, data + size, 0U, [](unsigned sum, std::uint8_t byte) {
    return (sum ^ byte) * 16777619U;  // FNV-1a
  });
  const auto baked = bake_memory({reinterpret_cast<const std::byte*>(data), size}, options_of(choice >> 16U));
  if (!baked) return baked.error().code == ErrorCode::kInternal ? (__builtin_trap(), 0) : 0;
  const auto& glb = baked->glb;
  if (!read_document({reinterpret_cast<const std::uint8_t*>(glb.data()), glb.size()}, {})) __builtin_trap();
  return 0;
}
