// The inside of RayScene, for the files that trace: ray_scene, item_buffer_rays, occlusion and single_ray. No other may
// include it.
#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include "core/visibility/ray_scene.h"

namespace radiosity {

/// What Embree carries along while it traces one packet. See-through triangles ask it what their hits must stop.
struct RayContext {
  RTCIntersectContext embree;
  /// The opacity needed to stop the ray numbered `ray_id` among `rays`.
  float (*threshold)(const void* rays, unsigned ray_id);
  const void* rays;
};
static_assert(std::is_standard_layout_v<RayContext>, "Embree hands back a pointer to the first member");

/// Embree counts references; each of ours is held by one owner.
struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
  void operator()(RTCBuffer buffer) const { rtcReleaseBuffer(buffer); }
};
template <typename Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

struct RayScene::Impl {
  /// Geometries by Embree's geomID.
  enum Geometry : unsigned { kOpaque = 0, kSeeThrough = 1, kGeometryCount = 2 };

  explicit Impl(const Scene& world);

  const Scene& scene;
  /// Scene triangle of each primID, [geomID][primID].
  std::array<std::vector<std::uint32_t>, kGeometryCount> triangle_of;
  Owned<RTCDevice> device;
  Owned<RTCScene> embree;
  bool native_packets_of_16 = false;
};

}  // namespace radiosity
