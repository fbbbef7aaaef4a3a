// Tries in a process of its own what may crash or never end, as libraries do on data that nobody can check for them.
#pragma once

#include <functional>

namespace gltf_radiosity {

enum class TrialEnd {
  kWell,       ///< so will the same work here
  kCrashed,    ///< or left no memory
  kTooLong,    ///< took more than its CPU time
  kNoProcess,  ///< the system has none to spare
};

/// Runs `work` in a copy of this process (fork) that may take `seconds` of CPU time, and waits for its end. Nothing of
/// what it does is seen here. `work` may not wait for other threads, for the copy has none; what it throws counts as a
/// crash.
TrialEnd try_in_child(const std::function<void()>& work, unsigned seconds);

}  // namespace gltf_radiosity
