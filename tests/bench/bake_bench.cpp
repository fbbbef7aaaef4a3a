// A whole bake of the Cornell box, from the scene to light at every vertex: against the number of vertices, and with
// one thread and all. items_per_second counts vertices.
#include <benchmark/benchmark.h>

#include <cstdint>

#include "core/bake.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

void bake_cornell_box(benchmark::State& state, const BakeOptions& options) {
  const Scene scene = test::cornell_box();
  BakeReport report;
  for (auto _ : state) report = bake(scene, options, {}).report;
  state.SetItemsProcessed(state.iterations() * std::int64_t{report.vertex_count});
  state.counters["vertices"] = report.vertex_count;
  state.counters["elements"] = report.element_count;
  state.counters["patches"] = report.patch_count;
}

/// Patch sizes in millimetres; the box is 0.55 m wide.
void BM_BakeBySize(benchmark::State& state) {
  BakeOptions options;
  options.subdivide.patch_size = 0.001F * static_cast<float>(state.range(0));
  bake_cornell_box(state, options);
}

/// What --quality draft, medium and high set.
void BM_BakeByQuality(benchmark::State& state) {
  BakeOptions options;
  options.subdivide.patch_size = 0.03F;
  options.hemicube_resolution = static_cast<int>(state.range(0));
  bake_cornell_box(state, options);
}

/// 0 is every core.
void BM_BakeByThreads(benchmark::State& state) {
  BakeOptions options;
  options.subdivide.patch_size = 0.03F;
  options.threads = static_cast<int>(state.range(0));
  bake_cornell_box(state, options);
}

/// Every core works: wall time and the CPU time of the whole process.
void whole_bakes(benchmark::internal::Benchmark* bench) {
  bench->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}
BENCHMARK(BM_BakeBySize)->Apply(whole_bakes)->ArgName("mm")->Arg(200)->Arg(100)->Arg(50)->Arg(25)->Arg(12);
BENCHMARK(BM_BakeByQuality)->Apply(whole_bakes)->ArgName("cells")->Arg(8)->Arg(16)->Arg(32);
BENCHMARK(BM_BakeByThreads)->Apply(whole_bakes)->ArgName("threads")->Arg(1)->Arg(2)->Arg(0);

}  // namespace
}  // namespace radiosity
