#include "core/reconstruct/gather.h"

#include <algorithm>
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

/// Adds the smooth sky to the direct light of its group and what patches send to the light of each. In seen.direct is
/// what shadow rays brought.
void see_groups(const Gatherer& gatherer, const Viewpoint& viewpoint, const ItemBuffer& buffer, const Seen& seen) {
  const std::span<const float> delta = gatherer.hemicube.delta_form_factors();
  const std::size_t group_count = gatherer.log->group_count;
  if (gatherer.sees_sources) {
    const Rgb sky = luminance_of_sky(gatherer.sky, gatherer.hemicube, viewpoint, buffer);
    seen.direct[gatherer.scene.sky.light_group] += irradiance_of_luminance(sky, 1.0F);
  }
  std::ranges::copy(seen.direct, seen.irradiance.begin());
  for (std::size_t c = 0; c < delta.size(); ++c) {
    if (buffer.triangle[c] == kNothing) continue;
    const std::uint32_t patch =
        gatherer.patches.patch_at(buffer.triangle[c], buffer.barycentrics[c], buffer.back[c] != 0);
    if (patch == kNothing) continue;
    if (!seen.patch_of_cell.empty()) seen.patch_of_cell[c] = patch;
    const Rgb* sent = gatherer.log->radiosity.data() + patch * group_count;
    for (std::size_t g = 0; g < group_count; ++g) seen.irradiance[g] += delta[c] * sent[g];
  }
}

}  // namespace

Gathered Gatherer::at(const SurfacePoint& point, std::uint32_t index, const Seen* seen) const {
  thread_local ItemBuffer buffer;
  const Viewpoint viewpoint{point.position + offset * point.normal, point.normal, low_discrepancy_twist(index)};
  items.fill(hemicube, viewpoint, buffer);
  if (seen != nullptr) seen->clear();

  // What each cell sees, by how much it counts.
  Gathered gathered;
  Rgb luminance(0.0F);
  const Rgb sky_dimmer = dimmer_of(scene, scene.sky.light_group);
  const Rgb constant_sky = sky.constant() * sky_dimmer;
  const std::span<const float> delta = hemicube.delta_form_factors();
  for (std::size_t c = 0; c < delta.size(); ++c) {
    const std::uint32_t triangle = buffer.triangle[c];
    if (triangle == kNothing) {
      if (sees_sources && sky.is_constant()) luminance += delta[c] * constant_sky;
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
  if (sees_sources && !sky.is_constant()) luminance += luminance_of_sky(sky, hemicube, viewpoint, buffer) * sky_dimmer;
  gathered.irradiance = irradiance_of_luminance(luminance, 1.0F);
  if (sees_sources) gathered.irradiance += direct.at(point, index, seen != nullptr ? seen->direct : std::span<Rgb>());
  if (seen != nullptr) see_groups(*this, viewpoint, buffer, *seen);
  return gathered;
}

bool Gatherer::only_back_is_reached(std::uint32_t triangle, Barycentrics place) const {
  return patches.is_unreached(triangle, place, false) && patches.patch_at(triangle, place, true) != kNothing &&
         !patches.is_unreached(triangle, place, true);
}

Gathered Gatherer::on_front(std::uint32_t triangle, Barycentrics place, const SurfacePoint& point, std::uint32_t index,
                            const Seen* seen) const {
  const bool unreached = patches.is_unreached(triangle, place, false);
  const std::optional<Gathered> dark = unreached ? seen_in_the_dark(*this, point, index) : std::nullopt;
  if (!dark) return at(point, index, seen);
  if (seen != nullptr) seen->clear();
  return *dark;
}

}  // namespace radiosity
