// Rows of F per second, samples of direct light per second, and both solvers over rows that lie ready. One thread for
// rows and samples; every counter is items_per_second.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "core/mesh/patches.h"
#include "core/transport/direct_light.h"
#include "core/transport/form_factors.h"
#include "core/transport/solve_gathering.h"
#include "core/transport/solve_progressive.h"
#include "core/visibility/item_buffer_raster.h"
#include "core/visibility/item_buffer_rays.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

/// A room with boxes and a lamp, its patches, and what traces it.
struct Room {
  Room(std::int64_t boxes, std::int64_t cut, std::int64_t max_patches)
      : scene(test::tessellated(test::many_boxes(static_cast<int>(boxes), 1), static_cast<int>(cut))),
        rays(scene),
        patches(make_patches(rays, {.max_patches = static_cast<int>(max_patches)}, {})) {}
  Scene scene;
  RayScene rays;
  Patches patches;
};

void note_sizes(benchmark::State& state, const Room& room) {
  state.counters["triangles"] = static_cast<double>(room.scene.triangles.size());
  state.counters["patches"] = room.patches.patch_count();
}

/// Every patch in turn; a stride that shares no factor with most counts keeps neighbours apart.
class PatchInTurn {
 public:
  explicit PatchInTurn(std::uint32_t patch_count) : patch_count_(patch_count) {}
  std::uint32_t next() { return patch_ = (patch_ + 7919) % patch_count_; }

 private:
  std::uint32_t patch_count_;
  std::uint32_t patch_ = 0;
};

void make_rows(benchmark::State& state, const Room& room, const ItemBufferMaker& items) {
  const Hemicube hemicube(static_cast<int>(state.range(3)));
  const SmoothSky sky(room.scene.sky, hemicube.resolution());
  const auto rows = make_hemicube_rows(room.patches, hemicube, items, sky, surface_offset(room.scene));
  PatchInTurn patch(rows->patch_count());
  for (auto _ : state) benchmark::DoNotOptimize(rows->row(patch.next()));
  state.SetItemsProcessed(state.iterations());
  note_sizes(state, room);
}

void BM_RowsOfFByRaster(benchmark::State& state) {
  const Room room(state.range(0), state.range(1), state.range(2));
  make_rows(state, room, *make_item_buffer_raster(room.scene));
}

void BM_RowsOfFByRays(benchmark::State& state) {
  const Room room(state.range(0), state.range(1), state.range(2));
  make_rows(state, room, *make_item_buffer_rays(room.rays));
}

/// Samples at the points of the patches: lamps by shadow rays.
void BM_DirectLight(benchmark::State& state) {
  const Room room(state.range(0), state.range(1), 2000);
  const DirectLight direct(room.rays, room.patches, {});
  PatchInTurn patch(room.patches.patch_count());
  std::uint32_t index = 0;
  for (auto _ : state) benchmark::DoNotOptimize(direct.at(room.patches.points_of(patch.next()).front(), index++));
  state.SetItemsProcessed(state.iterations());
  note_sizes(state, room);
  state.counters["lamps"] = static_cast<double>(room.patches.lamps.size());
}

/// A solver alone: every row of F is there before the clock starts. Items are the solver's steps.
template <typename Solve>
void solve(benchmark::State& state, const Solve& solver) {
  const Room room(10, 1, state.range(0));
  const Hemicube hemicube(16);
  const auto items = make_item_buffer_rays(room.rays);
  const SmoothSky sky(room.scene.sky, hemicube.resolution());
  const auto source = make_hemicube_rows(room.patches, hemicube, *items, sky, surface_offset(room.scene));
  RowCache rows(*source, std::numeric_limits<std::size_t>::max());
  std::vector<std::uint32_t> all(room.patches.patch_count());
  std::iota(all.begin(), all.end(), 0U);
  rows.fetch(all);
  const std::vector<Rgb> direct = direct_on_patches(DirectLight(room.rays, room.patches, {}), room.patches, {});
  std::int64_t steps = 0;
  for (auto _ : state) steps += solver(SolveProblem{room.patches, direct, 0.001F}, rows, Progress{}).steps;
  state.SetItemsProcessed(steps);
  note_sizes(state, room);
}

void BM_SolveProgressive(benchmark::State& state) { solve(state, solve_progressive); }
void BM_SolveGathering(benchmark::State& state) { solve(state, solve_gathering); }

// 114, 414, 6.6 k and 166 k triangles; the hemicubes of --quality draft, medium and high.
void rooms(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"boxes", "cut", "max_patches", "cells"});
  for (const int cells : {16, 32, 64}) {
    bench->Args({10, 1, 2000, cells});
    bench->Args({40, 1, 2000, cells});
    bench->Args({40, 4, 2000, cells});
    bench->Args({40, 20, 2000, cells});
  }
}
BENCHMARK(BM_RowsOfFByRaster)->Apply(rooms);
BENCHMARK(BM_RowsOfFByRays)->Apply(rooms);
BENCHMARK(BM_DirectLight)->ArgNames({"boxes", "cut"})->Args({10, 1})->Args({40, 1})->Args({40, 4})->Args({40, 20});
void sizes(benchmark::internal::Benchmark* bench) {
  bench->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
  bench->ArgName("max_patches")->Arg(500)->Arg(2000)->Arg(6000);
}
BENCHMARK(BM_SolveProgressive)->Apply(sizes);
BENCHMARK(BM_SolveGathering)->Apply(sizes);

}  // namespace
}  // namespace radiosity
