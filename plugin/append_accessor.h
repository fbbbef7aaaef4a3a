// New data: bytes at the end of one growing buffer, and the bufferView and accessor that describe them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
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
  /// Replaces bytes at an offset. REQUIRES: they were appended.
  void replace(std::size_t offset, std::span<const std::uint8_t> bytes);

  /// Reserves room in another buffer, [document.buffers.size() + 1], aligned to 4 bytes, and returns the offset. It
  /// holds no data: decoders of EXT_meshopt_compression put there what they decode.
  std::size_t reserve_decoded(std::size_t size);
  std::size_t decoded_size() const { return decoded_size_; }

 private:
  Bytes bytes_;
  std::size_t decoded_size_ = 0;
};

/// Makes what `buffer` holds a buffer of the document, so that it can be read; `buffer` is empty afterwards and stands
/// for the next one.
void move_into(Document& document, BufferBuilder& buffer);

/// The smallest type for the indices of so many vertices: the largest number of a type means "restart the primitive".
ComponentType index_type(std::size_t vertex_count);

/// A list of triangles as indices of the smallest type for `vertex_count` vertices.
RawAccessor index_rows(std::span<const glm::uvec3> triangles, std::size_t vertex_count);

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
