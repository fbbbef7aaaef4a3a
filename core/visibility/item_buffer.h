// What each cell of a hemicube sees: the nearest surface, or nothing.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/scene.h"
#include "core/visibility/hemicube.h"

namespace radiosity {

/// Shapes: all [cell_count]. Reused between hemicubes: makers overwrite every cell.
struct ItemBuffer {
  std::vector<std::uint32_t> triangle;     ///< scene triangle, or kNothing where the cell looks into the open
  std::vector<Barycentrics> barycentrics;  ///< where on the triangle
  std::vector<std::uint8_t> back;          ///< 1 where the triangle shows its back

  void resize(int cell_count);
};

/// How opaque a see-through surface must be to stop the ray of `cell`: spread over [0,1), the same for every maker.
float opacity_threshold(const Viewpoint& viewpoint, int cell);

/// Fills item buffers. Made once per scene; `fill` may be called from several threads at once.
class ItemBufferMaker {
 public:
  virtual ~ItemBufferMaker() = default;
  /// Finds the nearest surface that does not let the cell's ray through (scene.h, lets_through) in front of
  /// `viewpoint`, for every cell of `hemicube`.
  virtual void fill(const Hemicube& hemicube, const Viewpoint& viewpoint, ItemBuffer& items) const = 0;
};

}  // namespace radiosity
