// Work for all cores, in chunks short enough to report progress and to stop between them.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <string_view>

#include "core/progress.h"
#include "core/thread_order.h"

namespace radiosity {

/// Does `work` on at most `threads` threads; 0 takes every core.
template <typename Work>
auto on_threads(int threads, const Work& work) -> decltype(work()) {
  if (threads <= 0) return work();
  auto limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                     static_cast<std::size_t>(threads));
  try {
    return work();
  } catch (const std::bad_alloc&) {
    // oneTBB may have run out of memory within a lock of its own, for which the end of `limit` would wait for ever.
    static_cast<void>(limit.release());
    throw;
  }
}

/// Calls `work(k)` once for every k in [first, last), concurrently, with the calling thread's ways of rounding and of
/// treating denormal numbers. Each call must write only what belongs to its k: then the result does not depend on the
/// number of threads.
template <typename Work>
void in_parallel(std::size_t first, std::size_t last, const Work& work) {
  ThreadOrder before, after;
  before.give();
  // Without a context of its own a loop rounds as oneTBB was first called, which may have been within a library.
  tbb::task_group_context context(tbb::task_group_context::bound,
                                  tbb::task_group_context::default_traits | tbb::task_group_context::fp_settings);
  const auto body = [&](const tbb::blocked_range<std::size_t>& range) {
    before.take();
    for (std::size_t k = range.begin(); k != range.end(); ++k) work(k);
    after.give();
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(first, last), body, context);
  after.take();
}

/// The same in chunks of `chunk` calls, which see what the chunks before them have written. Throws `Cancelled` between
/// chunks.
template <typename Work>
void parallel_in_chunks(std::size_t count, std::size_t chunk, const Progress& progress, std::string_view phase,
                        const Work& work) {
  for (std::size_t first = 0; first < count; first += chunk) {
    progress.update(phase, static_cast<double>(first) / static_cast<double>(count));
    in_parallel(first, std::min(first + chunk, count), work);
  }
  progress.update(phase, 1.0);
}

}  // namespace radiosity
