#include "tools/watchdog.h"

#include <unistd.h>

#include <utility>

#include "tools/interrupt.h"

namespace gltf_radiosity::tools {
namespace {

constexpr std::chrono::milliseconds kLook(50);
/// Together with the look and the cleaning up less than the second that is promised.
constexpr std::chrono::milliseconds kPatience(450);

}  // namespace

Watchdog::Watchdog(std::function<void()> last_words)
    : last_words_(std::move(last_words)), thread_([this] { watch(); }) {}

Watchdog::~Watchdog() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  wakes_.notify_one();
  thread_.join();
}

void Watchdog::watch() {
  std::unique_lock lock(mutex_);
  while (interrupted_by() == 0) {
    if (wakes_.wait_for(lock, kLook, [this] { return is_over_; })) return;
  }
  if (wakes_.wait_for(lock, kPatience, [this] { return is_over_; })) return;
  last_words_();
  ::_exit(128 + interrupted_by());
}

}  // namespace gltf_radiosity::tools
