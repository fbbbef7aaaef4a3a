#include "plugin/attribute_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gltf_radiosity {
namespace {

constexpr int kBitsOfLargestMesh = 18, kLeastBits = 14;
constexpr int kLeastExponent = -100;  ///< steps stay far from the smallest floats
constexpr float kMantissaLimit = 8388607.0F;

/// The smallest power of two that is not below `extent`.
int power_above(float extent) { return extent > 0.0F ? static_cast<int>(std::ceil(std::log2(extent))) : 0; }

}  // namespace

int position_grid(float mesh_extent, float largest_extent) {
  const int shared = power_above(largest_extent) - kBitsOfLargestMesh;
  const int own = mesh_extent > 0.0F ? power_above(mesh_extent) - kLeastBits : shared;
  return std::max(kLeastExponent, std::min(shared, own));
}

std::optional<int> attribute_grid(std::string_view semantic, int position_grid) {
  if (semantic == "POSITION") return position_grid;
  if (semantic == "NORMAL" || semantic == "TANGENT") return -11;
  if (semantic.starts_with("TEXCOORD_") || semantic.starts_with("WEIGHTS_") || semantic.starts_with("COLOR_")) {
    return -16;
  }
  return std::nullopt;
}

bool fits_grid(float value, int exponent) { return std::abs(std::ldexp(value, -exponent)) <= kMantissaLimit; }

}  // namespace gltf_radiosity
