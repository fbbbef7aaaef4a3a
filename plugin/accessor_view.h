// Accessors as numbers: typed, strided, sparse, normalised.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "plugin/document.h"

namespace gltf_radiosity {

/// glTF's componentType.
enum class ComponentType : std::uint16_t { kI8 = 5120, kU8 = 5121, kI16 = 5122, kU16 = 5123, kU32 = 5125, kF32 = 5126 };

std::size_t component_size(ComponentType type);  ///< bytes

/// How one element of an accessor lies in memory. Columns of matrices start at multiples of 4 bytes.
struct ElementLayout {
  ComponentType component = ComponentType::kF32;
  std::size_t columns = 1, rows = 1;
  std::size_t column_stride = 0;  ///< bytes from one column to the next
  std::size_t size = 0;           ///< bytes, padding included: the stride of tightly packed elements
};

/// The layout that `type` ("VEC3") and `component_type` (5126) describe; none if glTF does not know them.
std::optional<ElementLayout> element_layout(std::string_view type, std::uint64_t component_type);

/// An accessor with strides removed and sparse values applied.
struct RawAccessor {
  ComponentType component = ComponentType::kF32;
  int components = 1;  ///< per element: 1 for SCALAR, 3 for VEC3, 16 for MAT4 (column padding removed)
  bool normalized = false;
  std::size_t count = 0;
  Bytes bytes;  ///< [count * components * component_size], little endian, tightly packed
};

/// REQUIRES: `accessor` is an index into the accessors of a checked document. Accessors without a bufferView are zeros.
RawAccessor read_accessor(const Document& document, std::size_t accessor);

/// As floats, normalised integers mapped to [0,1] or [-1,1] as the specification says, [count * components].
std::vector<float> as_floats(const RawAccessor& raw);

/// As unsigned integers, [count * components]. REQUIRES: an unsigned integer component type.
std::vector<std::uint32_t> as_indices(const RawAccessor& raw);

/// Floats back into `like`'s component type: clamped and rounded to nearest where integers are stored. Inverse of
/// as_floats up to rounding. [floats.size() * component_size].
Bytes encode_floats(const std::vector<float>& floats, ComponentType component, bool normalized);

}  // namespace gltf_radiosity
