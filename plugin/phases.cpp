#include "plugin/phases.h"

#include <sys/resource.h>

#include <algorithm>
#include <string>
#include <utility>

namespace gltf_radiosity {
namespace {

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

}  // namespace

Phases::Phases(const Callbacks& callbacks) : callbacks_(callbacks) {
  progress_.report = [this](std::string_view phase, double done) { report(phase, done); };
  progress_.cancelled = callbacks.cancelled;
}

void Phases::close() {
  const Clock::time_point now = Clock::now();
  if (!phases_.empty()) {
    phases_[current_].seconds += std::chrono::duration<double>(now - since_).count();
    phases_[current_].peak_memory_bytes = peak_memory_bytes();
  }
  since_ = now;
}

void Phases::report(std::string_view phase, double done) {
  if (phases_.empty() || phases_[current_].name != phase) {
    close();
    const auto same =
        std::find_if(phases_.begin(), phases_.end(), [&](const PhaseReport& p) { return p.name == phase; });
    current_ = static_cast<std::size_t>(same - phases_.begin());
    if (same == phases_.end()) phases_.push_back({std::string(phase), 0.0, 0});
  }
  if (callbacks_.progress) callbacks_.progress(phase, done);
}

std::vector<PhaseReport> Phases::finish() {
  close();
  return std::exchange(phases_, {});
}

}  // namespace gltf_radiosity
