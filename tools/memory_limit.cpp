#include "tools/memory_limit.h"

#include <sys/resource.h>

#include <algorithm>
#include <thread>

namespace gltf_radiosity::tools {
namespace {

/// What a thread's stack reserves, though hardly any of it is ever used.
constexpr std::uint64_t kStackBytes = std::uint64_t{8} << 20U;
/// The program itself, libraries' data and the arenas of malloc.
constexpr std::uint64_t kBaseBytes = std::uint64_t{32} << 20U;

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
  const std::uint64_t wanted = bytes + kBaseBytes + kStackBytes * (thread_count + 2);
  if (limit.rlim_cur <= wanted) return;
  limit.rlim_cur = wanted;
  ::setrlimit(RLIMIT_DATA, &limit);
}

}  // namespace gltf_radiosity::tools
