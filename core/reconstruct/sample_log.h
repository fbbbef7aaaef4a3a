// The light of samples kept apart by light groups, before it is dimmed.
//
// Light adds up: what a sample sees is the sum over groups of lights, lamps and sky, each times its dimmer. Kept by the
// number that a sample gets when it is taken, for samples move from element to element while the mesh is cut.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/rgb.h"

namespace radiosity {

/// Where the light of one sample is kept. `patch_of_cell` is empty where that is not kept.
struct Seen {
  std::span<Rgb> direct;                   ///< [group_count]: straight from lamps, lights and sky, lx
  std::span<Rgb> irradiance;               ///< [group_count]: that and what patches send, lx
  std::span<std::uint32_t> patch_of_cell;  ///< [cell_count]: what each cell of the hemicube sees, or kNothing

  void clear() const;
};

/// Shapes: per sample that was taken, buried ones included.
struct SampleLog {
  std::uint32_t group_count = 0;
  std::vector<Rgb> radiosity;  ///< what patches send: of each group, [patch_count * group_count], lm/m2

  std::uint32_t cell_count = 0;    ///< of a hemicube; 0: what cells see is not kept
  std::size_t max_cell_bytes = 0;  ///< nor if it would take more than this
  std::vector<Rgb> direct, irradiance;
  std::vector<std::uint32_t> patch_of_cell;

  /// Makes room for samples below this number.
  void grow(std::size_t sample_count);
  /// REQUIRES: there is room. Different numbers may be written to by different threads.
  Seen seen_by(std::uint32_t number);
};

}  // namespace radiosity
