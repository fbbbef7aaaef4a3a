// sRGB bytes -> linear.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace gltf_radiosity {

inline std::array<float, 256> make_srgb_table() {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double encoded = static_cast<double>(i) / 255.0;
    table[i] = static_cast<float>(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
  }
  return table;
}

/// The linear number, [0,1], that each sRGB byte stands for.
inline const std::array<float, 256> kSrgbToLinear = make_srgb_table();

}  // namespace gltf_radiosity
