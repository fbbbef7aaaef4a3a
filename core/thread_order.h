// Tells ThreadSanitizer what oneTBB guarantees and cannot show it, for its library is compiled without that sanitizer:
// a loop's calls see all that came before the loop, and what comes after the loop sees all that they did. Without
// ThreadSanitizer nothing of it is left.
#pragma once

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace radiosity {

#if defined(__SANITIZE_THREAD__)
/// One loop. Everything before `give()` on one thread comes before what follows `take()` on another.
class ThreadOrder {
 public:
  void give() { __tsan_release(this); }
  void take() { __tsan_acquire(this); }
};
#else
class ThreadOrder {
 public:
  void give() {}
  void take() {}
};
#endif

}  // namespace radiosity
