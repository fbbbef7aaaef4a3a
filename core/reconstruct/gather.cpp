#include "core/reconstruct/gather.h"

#include <optional>

#include "core/photometry.h"
#include "core/transport/sky_light.h"

namespace radiosity {
namespace {

/// What a point sees that sees nothing but backs and what no light reaches; nothing if it sees more: a patch may lie
/// half in the dark.
std::optional<Gathered> seen_in_the_dark(const Gatherer& gatherer, const SurfacePoint& point, std::uint32_t index) {
  thread_local ItemBuffer buffer;
  static const Hemicube narrow(4);
  const glm::vec3 lifted = point.position + gatherer.offset * point.normal;
  gatherer.items.fill(narrow, {lifted, point.normal, low_discrepancy_twist(index)}, buffer);
  Gathered gathered;
  for (std::size_t c = 0; c < buffer.triangle.size(); ++c) {
    if (buffer.triangle[c] == kNothing) return std::nullopt;
    const Patches& patches = gatherer.patches;
    const std::uint32_t patch = patches.patch_at(buffer.triangle[c], buffer.barycentrics[c], buffer.back[c] != 0);
    if (patch != kNothing && patch != patches.unreached) return std::nullopt;
    if (patch == kNothing) gathered.back_share += narrow.delta_form_factors()[c];
  }
  return gathered;
}

}  // namespace

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
      if (sees_sources && sky.is_constant()) luminance += delta[c] * sky.constant();
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
  if (sees_sources && !sky.is_constant()) luminance += luminance_of_sky(sky, hemicube, viewpoint, buffer);
  gathered.irradiance = irradiance_of_luminance(luminance, 1.0F);
  if (sees_sources) gathered.irradiance += direct.at(point, index);
  return gathered;
}

bool Gatherer::only_back_is_reached(std::uint32_t triangle, Barycentrics place) const {
  return patches.is_unreached(triangle, place, false) && patches.patch_at(triangle, place, true) != kNothing &&
         !patches.is_unreached(triangle, place, true);
}

Gathered Gatherer::on_front(std::uint32_t triangle, Barycentrics place, const SurfacePoint& point,
                            std::uint32_t index) const {
  const bool unreached = patches.is_unreached(triangle, place, false);
  const std::optional<Gathered> dark = unreached ? seen_in_the_dark(*this, point, index) : std::nullopt;
  return dark ? *dark : at(point, index);
}

}  // namespace radiosity
