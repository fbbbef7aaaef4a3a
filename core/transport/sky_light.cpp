#include "core/transport/sky_light.h"

#include <algorithm>
#include <numeric>

#include "core/photometry.h"

namespace radiosity {

Rgb luminance_of_sky(const SmoothSky& sky, const Hemicube& hemicube, const Viewpoint& viewpoint,
                     const ItemBuffer& items) {
  const Frame axes = frame(viewpoint);
  const std::span<const float> delta = hemicube.delta_form_factors();
  const std::span<const glm::vec3> directions = hemicube.directions();
  Rgb sum(0.0F);
  for (std::size_t c = 0; c < delta.size(); ++c) {
    if (items.triangle[c] != kNothing) continue;
    const glm::vec3& d = directions[c];
    sum += delta[c] * sky.luminance(d.x * axes.u + d.y * axes.v + d.z * axes.w);
  }
  return sum;
}

std::vector<Rgb> sky_on_patches(const SmoothSky& sky, RowCache& rows, const Progress& progress) {
  if (sky.is_black()) return {};
  std::vector<Rgb> irradiance(rows.patch_count());
  std::vector<std::uint32_t> order(rows.patch_count());
  std::iota(order.begin(), order.end(), 0U);
  constexpr std::size_t kPatchesAtOnce = 256;
  for (std::size_t first = 0; first < order.size(); first += kPatchesAtOnce) {
    progress.update("sky", static_cast<double>(first) / static_cast<double>(order.size()));
    const std::size_t count = std::min(kPatchesAtOnce, order.size() - first);
    rows.fetch(std::span(order).subspan(first, count));
    for (std::size_t i = first; i < first + count; ++i) {
      const FormFactorRow& row = rows.row(order[i]);
      irradiance[i] = sky.is_constant() ? irradiance_of_luminance(sky.constant(), row.to_sky)
                                        : irradiance_of_luminance(row.sky, 1.0F);
    }
  }
  return irradiance;
}

}  // namespace radiosity
