// Item buffer -> a row of F: the share of a patch's light that reaches every other patch directly.
//
// F_ij is the sum of the delta form factors of the hemicube cells that see patch j, averaged over hemicubes at several
// points of patch i: one at the centre alone goes wrong between near patches (0.2395 instead of 0.1998 between opposite
// faces of a cube; Baum, Rushmeier and Winget 1989).
//
// Rows are asked for through RowSource, so that another maker (a graphics card, a cluster) can stand behind the
// solvers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/mesh/patches.h"
#include "core/transport/sky_parts.h"
#include "core/visibility/hemicube.h"
#include "core/visibility/item_buffer.h"

namespace radiosity {

/// Row i of F, sparse. The factors, `to_sky` and `to_backs` sum to 1.
struct FormFactorRow {
  std::vector<std::uint32_t> patch;  ///< j, ascending
  std::vector<float> factor;         ///< F_ij, > 0
  float to_sky = 0.0F;               ///< share that meets nothing
  float to_backs = 0.0F;             ///< share that ends on backs which send no light
  Rgb sky{0.0F};                     ///< sum of what a sky with a map shows, times the factors of its cells, cd/m2

  std::size_t bytes() const { return patch.size() * (sizeof(std::uint32_t) + sizeof(float)) + sizeof(*this); }
};

/// Computes rows of F. Thread-safe: every row is a pure function of its index.
class RowSource {
 public:
  virtual ~RowSource() = default;
  virtual std::uint32_t patch_count() const = 0;
  virtual FormFactorRow row(std::uint32_t patch) const = 0;
};

/// Rows by hemicubes at the points of each patch. All arguments must outlive it.
std::unique_ptr<RowSource> make_hemicube_rows(const Patches& patches, const Hemicube& hemicube,
                                              const ItemBufferMaker& items, const SmoothSky& sky, float surface_offset);

/// Rows kept within a memory bound: what was used longest ago is evicted and computed again when needed.
///
/// Not thread-safe, though `fetch` computes on all cores.
class RowCache {
 public:
  /// `source` must outlive the cache. At least one batch of rows is always kept.
  RowCache(const RowSource& source, std::size_t max_bytes) : source_(source), max_bytes_(max_bytes) {}

  /// Computes those of `patches` that are missing, side by side.
  void fetch(std::span<const std::uint32_t> patches);
  bool holds(std::uint32_t patch) const { return slot_of_patch_.contains(patch); }
  bool holds_all() const { return slots_.size() == patch_count(); }
  /// The row of `patch`, or null where it is not at hand. Valid until the next fetch().
  const FormFactorRow* peek(std::uint32_t patch) const {
    const auto slot = slot_of_patch_.find(patch);
    return slot == slot_of_patch_.end() ? nullptr : &slot->second->row;
  }
  /// The row of `patch`, computed if missing. Valid until the next fetch() or row().
  const FormFactorRow& row(std::uint32_t patch);

  std::uint32_t patch_count() const { return source_.patch_count(); }
  std::uint64_t computed_count() const { return computed_count_; }

 private:
  struct Slot {
    std::uint32_t patch;
    FormFactorRow row;
  };
  void evict(std::size_t keep);

  const RowSource& source_;
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::uint64_t computed_count_ = 0;
  std::list<Slot> slots_;  // most recently used first
  std::unordered_map<std::uint32_t, std::list<Slot>::iterator> slot_of_patch_;
};

}  // namespace radiosity
