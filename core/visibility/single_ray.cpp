#include "core/visibility/single_ray.h"

#include <algorithm>

#include "core/visibility/embree_scene.h"

namespace radiosity {
namespace {

float threshold_of_hit(const void* draw, unsigned /*ray*/) { return (*static_cast<const DrawThreshold*>(draw))(); }

/// Neighbouring rays have nothing in common.
RayContext context_of(const DrawThreshold& threshold) {
  RayContext context{{}, threshold_of_hit, &threshold};
  rtcInitIntersectContext(&context.embree);
  return context;
}

RTCRay embree_ray(const Ray& ray) {
  RTCRay result{};
  result.org_x = ray.from.x;
  result.org_y = ray.from.y;
  result.org_z = ray.from.z;
  result.dir_x = ray.direction.x;
  result.dir_y = ray.direction.y;
  result.dir_z = ray.direction.z;
  result.tfar = ray.length;
  result.mask = ~0U;
  return result;
}

/// What a search for near triangles collects.
struct Search {
  const RayScene::Impl& inside;
  std::vector<std::uint32_t> found;
};

bool collect(RTCPointQueryFunctionArguments* arguments) {
  auto& search = *static_cast<Search*>(arguments->userPtr);
  search.found.push_back(search.inside.triangle_of[arguments->geomID][arguments->primID]);
  return false;  // the radius stays
}

}  // namespace

std::optional<Hit> nearest_hit(const RayScene& scene, const Ray& ray, const DrawThreshold& threshold) {
  RayContext context = context_of(threshold);
  RTCRayHit query{embree_ray(ray), {}};
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene.impl().embree.get(), &context.embree, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const float along_normal =
      query.ray.dir_x * query.hit.Ng_x + query.ray.dir_y * query.hit.Ng_y + query.ray.dir_z * query.hit.Ng_z;
  return Hit{scene.impl().triangle_of[query.hit.geomID][query.hit.primID],
             {query.hit.u, query.hit.v},
             query.ray.tfar,
             along_normal > 0.0F};
}

bool is_blocked(const RayScene& scene, const Ray& ray, const DrawThreshold& threshold) {
  RayContext context = context_of(threshold);
  RTCRay query = embree_ray(ray);
  rtcOccluded1(scene.impl().embree.get(), &context.embree, &query);
  return query.tfar < 0.0F;  // so Embree says yes
}

std::vector<std::uint32_t> triangles_near(const RayScene& scene, const glm::vec3& position, float radius) {
  Search search{scene.impl(), {}};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  RTCPointQuery query{position.x, position.y, position.z, 0.0F, radius};
  rtcPointQuery(search.inside.embree.get(), &query, &context, collect, &search);
  std::sort(search.found.begin(), search.found.end());
  return std::move(search.found);
}

}  // namespace radiosity
