// New data: bytes at the end of one growing buffer, and the bufferView and accessor that describe them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "plugin/accessor_view.h"
#include "plugin/document.h"

namespace gltf_radiosity {

/// Where exporters put new data: one growing buffer that becomes the last one of the document.
class BufferBuilder {
 public:
  /// Appends, aligned to 4 bytes, and returns the offset.
  std::size_t append(std::span<const std::uint8_t> bytes);
  const Bytes& bytes() const { return bytes_; }

 private:
  Bytes bytes_;
};

/// Sets `accessor`'s min and max to those of `raw`, in the stored component type. REQUIRES: raw.count > 0.
void set_bounds(const RawAccessor& raw, Json& accessor);

/// What a bufferView is for, with glTF's numbers.
enum class BufferTarget : std::uint16_t { kVertices = 34962, kIndices = 34963 };

/// Appends `raw` to `buffer`, and a bufferView and an accessor to the tree; returns the accessor's index. The accessor
/// is a copy of `like` (name, extras, type of matrices) with the members that describe the data replaced. Rows of
/// vertices start at multiples of 4 bytes. Bounds are computed if `bounds` is set or `like` has them, in the stored
/// component type. REQUIRES: raw.count > 0.
std::size_t append_accessor(Document& document, BufferBuilder& buffer, const RawAccessor& raw, BufferTarget target,
                            Json like = Json::object(), bool bounds = false);

}  // namespace gltf_radiosity
