#include "core/reconstruct/gather.h"

#include "core/photometry.h"
#include "core/transport/sky_light.h"

namespace radiosity {
Gathered Gatherer::at(const SurfacePoint& point, std::uint32_t index) const {
  thread_local ItemBuffer buffer;
  const Viewpoint viewpoint{point.position + offset * point.normal, point.normal, low_discrepancy_twist(index)};
  items.fill(hemicube, viewpoint, buffer);

  // What each cell sees, by how much it counts.
  Gathered gathered;
  Rgb luminance(0.0F);
  const std::span<const float> delta = hemicube.delta_form_factors();
  for (std::size_t c = 0; c < delta.size(); ++c) {
    const std::uint32_t triangle = buffer.triangle[c];
    if (triangle == kNothing) {
      if (sky.is_constant()) luminance += delta[c] * sky.constant();
      continue;
    }
    const std::uint32_t patch = patches.patch_at(triangle, buffer.barycentrics[c], buffer.back[c] != 0);
    if (patch == kNothing) {
      gathered.back_share += delta[c];
    } else {
      luminance += delta[c] * luminance_of_radiosity(radiosity[patch]);
    }
  }
  if (gathered.back_share > kBuriedShare) return gathered;
  if (!sky.is_constant()) luminance += luminance_of_sky(sky, hemicube, viewpoint, buffer);
  gathered.irradiance = irradiance_of_luminance(luminance, 1.0F) + direct.at(point, index);
  return gathered;
}

}  // namespace radiosity
