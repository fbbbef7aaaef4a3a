// Cells of hemicubes per second: both item buffers, and Embree alone on the rays of the second, against the number of
// triangles. One thread; every counter is items_per_second.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "core/visibility/embree_scene.h"
#include "core/visibility/item_buffer_raster.h"
#include "core/visibility/item_buffer_rays.h"
#include "core/visibility/occlusion.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

/// Enough viewpoints that no cache remembers one, and the same for every benchmark.
constexpr int kViewpointCount = 64;

/// A room with `boxes` boxes, each triangle cut into cut x cut, ready to trace, and viewpoints on its surfaces.
struct World {
  World(std::int64_t boxes, std::int64_t cut)
      : scene(test::tessellated(test::many_boxes(static_cast<int>(boxes), 1), static_cast<int>(cut))), rays(scene) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0.0F, 0.5F);
    for (std::uint32_t k = 0; k < kViewpointCount; ++k) {
      const auto triangle = static_cast<std::uint32_t>(random() % scene.triangles.size());
      const glm::vec3 normal = glm::normalize(scaled_normal(scene, triangle));
      const glm::vec3 at = point_at(scene, triangle, {unit(random), unit(random)});
      viewpoints.push_back({at + surface_offset(scene) * normal, normal, low_discrepancy_twist(k)});
    }
  }
  Scene scene;
  RayScene rays;
  std::vector<Viewpoint> viewpoints;
};

void fill_all(benchmark::State& state, const World& world, const ItemBufferMaker& maker) {
  const Hemicube hemicube(static_cast<int>(state.range(2)));
  ItemBuffer items;
  std::size_t k = 0;
  for (auto _ : state) {
    maker.fill(hemicube, world.viewpoints[k++ % kViewpointCount], items);
    benchmark::DoNotOptimize(items.triangle.data());
  }
  state.SetItemsProcessed(state.iterations() * hemicube.cell_count());
  state.counters["triangles"] = static_cast<double>(world.scene.triangles.size());
}

void BM_ItemBufferRaster(benchmark::State& state) {
  const World world(state.range(0), state.range(1));
  fill_all(state, world, *make_item_buffer_raster(world.scene));
}

void BM_ItemBufferRays(benchmark::State& state) {
  const World world(state.range(0), state.range(1));
  fill_all(state, world, *make_item_buffer_rays(world.rays));
}

/// The packets of one hemicube: tiles of 4 x 4 cells.
std::vector<RTCRayHit16> packets_of(const Hemicube& hemicube, const Viewpoint& viewpoint) {
  const Frame axes = frame(viewpoint);
  std::vector<RTCRayHit16> packets;
  for (const Hemicube::Face& face : hemicube.faces()) {
    for (int tile = 0; tile < face.rows * face.columns / 16; ++tile) {
      RTCRayHit16& packet = packets.emplace_back();
      for (int lane = 0; lane < 16; ++lane) {
        const int column = tile % (face.columns / 4) * 4 + lane % 4;
        const int row = tile / (face.columns / 4) * 4 + lane / 4;
        const glm::vec3 d =
            hemicube.directions()[static_cast<std::size_t>(face.first_cell + row * face.columns + column)];
        const glm::vec3 direction = d.x * axes.u + d.y * axes.v + d.z * axes.w;
        packet.ray.org_x[lane] = viewpoint.position.x;
        packet.ray.org_y[lane] = viewpoint.position.y;
        packet.ray.org_z[lane] = viewpoint.position.z;
        packet.ray.dir_x[lane] = direction.x;
        packet.ray.dir_y[lane] = direction.y;
        packet.ray.dir_z[lane] = direction.z;
        packet.ray.mask[lane] = ~0U;
      }
    }
  }
  return packets;
}

/// What Embree does by itself with rays that lie ready: the ceiling for BM_ItemBufferRays.
void BM_EmbreeAlone(benchmark::State& state) {
  const World world(state.range(0), state.range(1));
  const Hemicube hemicube(static_cast<int>(state.range(2)));
  std::vector<std::vector<RTCRayHit16>> packets;
  for (const Viewpoint& viewpoint : world.viewpoints) {
    packets.push_back(packets_of(hemicube, viewpoint));
  }
  alignas(64) int active[16];
  std::fill_n(active, 16, -1);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  std::size_t k = 0;
  for (auto _ : state) {
    for (RTCRayHit16& packet : packets[k++ % kViewpointCount]) {
      std::fill_n(packet.ray.tfar, 16, std::numeric_limits<float>::infinity());
      std::fill_n(packet.hit.geomID, 16, RTC_INVALID_GEOMETRY_ID);
      rtcIntersect16(active, world.rays.impl().embree.get(), &context, &packet);
    }
  }
  state.SetItemsProcessed(state.iterations() * hemicube.cell_count());
}

/// Shadow rays from points of the room to the lamp.
void BM_ShadowRays(benchmark::State& state) {
  const World world(state.range(0), state.range(1));
  std::vector<ShadowRay> rays;
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(-0.5F, 0.5F);
  for (const Viewpoint& viewpoint : world.viewpoints) {
    for (int i = 0; i < 16; ++i) {
      const glm::vec3 to_lamp = glm::vec3(unit(random), 3.9F, unit(random)) - viewpoint.position;
      const float distance = glm::length(to_lamp);
      rays.push_back({viewpoint.position, to_lamp / distance, distance, 0.0F});
    }
  }
  std::vector<std::uint8_t> blocked(rays.size());
  for (auto _ : state) {
    trace_shadow_rays(world.rays, rays, blocked);
    benchmark::DoNotOptimize(blocked.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(rays.size()));
  state.counters["triangles"] = static_cast<double>(world.scene.triangles.size());
}

// 14, 64, 114, 214, 414 triangles as they are; the 414 cut finer: 1.7 k, 6.6 k, 26 k, 166 k, 662 k.
void worlds(benchmark::internal::Benchmark* bench) {
  constexpr std::array<std::pair<int, int>, 10> kWorlds = {
      {{0, 1}, {5, 1}, {10, 1}, {20, 1}, {40, 1}, {40, 2}, {40, 4}, {40, 8}, {40, 20}, {40, 40}}};
  bench->ArgNames({"boxes", "cut", "cells"});
  for (const auto& [boxes, cut] : kWorlds) {
    for (const int resolution : {16, 32, 128}) {
      bench->Args({boxes, cut, resolution});
    }
  }
}
BENCHMARK(BM_ItemBufferRaster)->Apply(worlds);
BENCHMARK(BM_ItemBufferRays)->Apply(worlds);
BENCHMARK(BM_EmbreeAlone)->Apply(worlds);
BENCHMARK(BM_ShadowRays)->ArgNames({"boxes", "cut"})->Args({10, 1})->Args({40, 4})->Args({40, 40});

}  // namespace
}  // namespace radiosity
