#include "core/transport/sky_light.h"

#include <algorithm>
#include <numeric>

#include "core/photometry.h"

namespace radiosity {

void add_sky(const Rgb& sky, RowCache& rows, std::vector<Rgb>& direct, const Progress& progress) {
  if (!(luminance_of(sky) > 0.0F)) return;
  std::vector<std::uint32_t> order(rows.patch_count());
  std::iota(order.begin(), order.end(), 0U);
  constexpr std::size_t kRowsAtOnce = 256;
  for (std::size_t first = 0; first < order.size(); first += kRowsAtOnce) {
    progress.update("sky", static_cast<double>(first) / static_cast<double>(order.size()));
    const std::size_t count = std::min(kRowsAtOnce, order.size() - first);
    rows.fetch(std::span(order).subspan(first, count));
    for (std::size_t i = first; i < first + count; ++i) {
      direct[i] += irradiance_of_luminance(sky, rows.row(order[i]).to_sky);
    }
  }
}

}  // namespace radiosity
