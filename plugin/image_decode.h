// Encoded images -> pixels: PNG (8 and 16 bit), JPEG and WebP through their own libraries, each behind its own bounds.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "plugin/memory_budget.h"
#include "plugin/result.h"

namespace gltf_radiosity {

/// 8-bit RGBA rows from the top; missing alpha is 255. 16-bit sources keep their upper 8 bits.
struct Pixels {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  ///< [height * width * 4]
};

/// Formats are told apart by content. `place` goes into errors: `images[2]: KTX2 textures are not supported`. At most
/// 2^28 pixels, and no more than fit into what is left of `memory`, if given.
Result<Pixels> decode_image(std::span<const std::uint8_t> bytes, const std::string& place,
                            const MemoryBudget* memory = nullptr);

/// The name of a format that glTF knows but nothing here decodes, such as "KTX2"; empty for all others.
std::string_view unsupported_format(std::span<const std::uint8_t> bytes);

}  // namespace gltf_radiosity
