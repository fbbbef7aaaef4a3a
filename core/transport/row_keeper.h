// Rows of F kept from one bake to the next. Form factors know nothing of reflectance, emission or the light of lamps:
// another lighting of the same geometry finds them again.
//
// An interface, for core knows no files.
#pragma once

#include <memory>

#include "core/mesh/patches.h"
#include "core/transport/form_factors.h"

namespace radiosity {

/// What rows of F follow from.
struct RowInputs {
  const Scene& scene;  ///< its shapes, which of its surfaces let light through, and the map of its sky
  const Patches& patches;
  int hemicube_resolution = 16;
  bool raster = false;  ///< which maker fills the item buffers
};

/// Not thread-safe.
class RowKeeper {
 public:
  virtual ~RowKeeper() = default;
  /// The rows that were kept for the same inputs, all of them; null if there are none. The same bytes as computed.
  virtual std::unique_ptr<RowSource> recall(const RowInputs& inputs) = 0;
  /// REQUIRES: `rows` holds the row of every patch.
  virtual void keep(const RowInputs& inputs, const RowCache& rows) = 0;
};

}  // namespace radiosity
