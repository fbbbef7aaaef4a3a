// Radiance HDR files made in memory, for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/rgb.h"
#include "plugin/document.h"

namespace gltf_radiosity {

/// A header, then whatever follows.
inline Bytes hdr_header(int width, int height) {
  const std::string text =
      "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " + std::to_string(width) + "\n";
  return {text.begin(), text.end()};
}

/// Texels without run lengths, rows from the top; exact for powers of two times a byte.
inline Bytes encode_hdr(int width, int height, const std::vector<radiosity::Rgb>& texels) {
  Bytes bytes = hdr_header(width, height);
  for (const radiosity::Rgb& texel : texels) {
    int exponent = 0;
    const float largest = std::max({texel.x, texel.y, texel.z});
    std::frexp(largest, &exponent);
    for (int band = 0; band < 3; ++band) {
      bytes.push_back(static_cast<std::uint8_t>(std::ldexp(texel[band], 8 - exponent)));
    }
    bytes.push_back(largest > 0.0F ? static_cast<std::uint8_t>(exponent + 128) : std::uint8_t{0});
  }
  return bytes;
}

}  // namespace gltf_radiosity
