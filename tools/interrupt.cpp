#include "tools/interrupt.h"

#include <atomic>
#include <csignal>

namespace gltf_radiosity::tools {
namespace {

// A signal handler gets nothing but a number, so this one flag has to live at namespace scope.
std::atomic<int> first_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "only lock-free atomics are safe in a signal handler");

}  // namespace

// Only calls that POSIX allows in a handler. From here on a second signal, of either kind, has its usual effect.
extern "C" {
static void remember_signal(int signal) {
  first_signal.store(signal, std::memory_order_relaxed);
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}
}

void catch_interrupts() {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that is larger than allowed is an error of writing it, then
  std::signal(SIGPIPE, SIG_IGN);  // and so is a report that nobody reads; to progress it does not matter
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction before = {};
    sigaction(signal, nullptr, &before);
    if (before.sa_handler == SIG_IGN) continue;
    struct sigaction action = {};
    action.sa_handler = remember_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(signal, &action, nullptr);
  }
}

int interrupted_by() { return first_signal.load(std::memory_order_relaxed); }

}  // namespace gltf_radiosity::tools
