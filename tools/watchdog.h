// Ends the process when it does not stop by itself soon after a signal.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace gltf_radiosity::tools {

/// What libraries do in one go cannot be interrupted: Draco in one large primitive, a tree of rays over millions of
/// triangles, JSON. While a watchdog lives, a signal (interrupt.h) ends the process within a second all the same, with
/// the exit code that shells expect, 128 and its number.
class Watchdog {
 public:
  /// `last_words` cleans up and says what happened, from a thread of its own, while everything else goes on.
  explicit Watchdog(std::function<void()> last_words);
  /// From here on the process ends by itself.
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

 private:
  void watch();

  std::function<void()> last_words_;
  std::mutex mutex_;
  std::condition_variable wakes_;
  bool is_over_ = false;
  std::thread thread_;
};

}  // namespace gltf_radiosity::tools
