#include "core/visibility/occlusion.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <glm/geometric.hpp>

#include "core/visibility/embree_scene.h"

namespace radiosity {
namespace {

constexpr std::size_t kPacketSize = 16;

float threshold_of_ray(const void* rays, unsigned ray) { return static_cast<const ShadowRay*>(rays)[ray].threshold; }

void set_lane(RTCRay16& packet, std::size_t lane, const ShadowRay& ray, std::size_t id) {
  packet.org_x[lane] = ray.from.x;
  packet.org_y[lane] = ray.from.y;
  packet.org_z[lane] = ray.from.z;
  packet.dir_x[lane] = ray.to_target.x;
  packet.dir_y[lane] = ray.to_target.y;
  packet.dir_z[lane] = ray.to_target.z;
  packet.tfar[lane] = ray.distance;
  packet.id[lane] = static_cast<unsigned>(id);
}

/// Whether rays leave one point in much the same direction, as those to the samples of one lamp do. Embree traces such
/// packets up to 1.7 times as fast when told so, and others at a third of the speed.
bool is_beam(std::span<const ShadowRay> rays) {
  constexpr float kCosine = 0.9F;
  return std::all_of(rays.begin(), rays.end(), [&first = rays.front()](const ShadowRay& ray) {
    return ray.from == first.from && glm::dot(ray.to_target, first.to_target) > kCosine;
  });
}

}  // namespace

void trace_shadow_rays(const RayScene& scene, std::span<const ShadowRay> rays, std::span<std::uint8_t> blocked) {
  assert(blocked.size() == rays.size());
  RayContext context{{}, threshold_of_ray, rays.data()};
  rtcInitIntersectContext(&context.embree);
  RTCRay16 packet{};
  std::fill_n(packet.mask, kPacketSize, ~0U);

  for (std::size_t first = 0; first < rays.size(); first += kPacketSize) {
    // Rays without number pad the last packet.
    const std::size_t count = std::min(kPacketSize, rays.size() - first);
    alignas(64) int active[kPacketSize] = {};
    for (std::size_t lane = 0; lane < count; ++lane) {
      set_lane(packet, lane, rays[first + lane], first + lane);
      active[lane] = -1;
    }

    context.embree.flags = is_beam(rays.subspan(first, count)) ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                                               : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;

    // Embree marks the rays that something blocks by a negative length.
    rtcOccluded16(active, scene.impl().embree.get(), &context.embree, &packet);
    for (std::size_t lane = 0; lane < count; ++lane) {
      blocked[first + lane] = packet.tfar[lane] < 0.0F ? 1 : 0;
    }
  }
}

}  // namespace radiosity
