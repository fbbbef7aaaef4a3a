#include "tools/memory_limit.h"

#include <sys/resource.h>

#include <algorithm>
#include <thread>

namespace gltf_radiosity::tools {
namespace {

/// What counts though hardly any of it is ever used: for each thread its stack and its arena of malloc, and what
/// libraries reserve. (A bake that keeps 16 MiB resident counts as 156 MiB with two threads.)
constexpr std::uint64_t kThreadBytes = std::uint64_t{16} << 20U;
constexpr std::uint64_t kBaseBytes = std::uint64_t{192} << 20U;

}  // namespace

void limit_memory(std::uint64_t bytes, int threads) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return;  // their shadows count
#endif
  // RLIMIT_DATA counts private memory that can be written; RLIMIT_AS would count what is only reserved, too.
  rlimit limit{};
  if (::getrlimit(RLIMIT_DATA, &limit) != 0) return;
  const auto thread_count =
      static_cast<std::uint64_t>(std::max(threads, static_cast<int>(std::thread::hardware_concurrency())));
  const std::uint64_t wanted = bytes + kBaseBytes + kThreadBytes * thread_count;
  if (limit.rlim_cur <= wanted) return;
  limit.rlim_cur = wanted;
  ::setrlimit(RLIMIT_DATA, &limit);
}

}  // namespace gltf_radiosity::tools
