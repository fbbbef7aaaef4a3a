#include "core/reconstruct/sample_log.h"

#include <algorithm>

#include "core/scene.h"

namespace radiosity {

void Seen::clear() const {
  std::ranges::fill(direct, Rgb(0.0F));
  std::ranges::fill(irradiance, Rgb(0.0F));
  std::ranges::fill(patch_of_cell, kNothing);
}

void SampleLog::grow(std::size_t sample_count) {
  direct.resize(sample_count * group_count);
  irradiance.resize(sample_count * group_count);
  if (sample_count * cell_count * sizeof(std::uint32_t) > max_cell_bytes) {
    cell_count = 0;
    patch_of_cell = {};
  }
  patch_of_cell.resize(sample_count * cell_count);
}

Seen SampleLog::seen_by(std::uint32_t number) {
  const std::size_t groups = group_count, cells = cell_count;
  return {std::span(direct).subspan(number * groups, groups), std::span(irradiance).subspan(number * groups, groups),
          std::span(patch_of_cell).subspan(number * cells, cells)};
}

}  // namespace radiosity
