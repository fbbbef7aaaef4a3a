// Radiance HDR (.hdr, RGBE) -> linear pixels, behind bounds of its own.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/rgb.h"
#include "plugin/memory_budget.h"
#include "plugin/result.h"

namespace gltf_radiosity {

/// Rows from the top.
struct HdrImage {
  int width = 0, height = 0;
  std::vector<radiosity::Rgb> texels;  ///< [height * width], finite and not negative
};

/// The largest image that is decoded.
inline constexpr int kMaxHdrWidth = 16384, kMaxHdrHeight = 8192;

/// `place` goes into errors: a file's name. More pixels than fit into what is left of `memory` are a limit. EXPOSURE
/// and PRIMARIES in the header are not looked at, as in the engines.
Result<HdrImage> decode_hdr(std::span<const std::uint8_t> bytes, const std::string& place,
                            const MemoryBudget& memory = MemoryBudget());

}  // namespace gltf_radiosity
