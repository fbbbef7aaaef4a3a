#include "plugin/phases.h"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace gltf_radiosity {
namespace {

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

/// After these there is light.
constexpr std::array<std::string_view, 6> kBeforeLight = {"read", "import", "subdivide", "patches", "direct", "sky"};

}  // namespace

Phases::Phases(const Callbacks& callbacks, double time_limit) : callbacks_(callbacks), time_limit_(time_limit) {
  progress_.report = [this](std::string_view phase, double done) { report(phase, done); };
  progress_.cancelled = callbacks.cancelled;
  if (time_limit_ > 0.0) progress_.seconds_left = [this] { return time_limit_ - seconds() - seconds_to_write(); };
}

/// About as long as reading took, but not most of the time.
double Phases::seconds_to_write() const {
  constexpr double kLargestShare = 0.3;
  double reading = 0.0;
  for (const PhaseReport& phase : phases_)
    reading += phase.name == "read" || phase.name == "import" ? phase.seconds : 0.0;
  return std::min(reading, kLargestShare * time_limit_);
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
  const bool before_light = std::ranges::find(kBeforeLight, phase) != kBeforeLight.end();
  if (before_light && progress_.is_short_of(0.0)) throw radiosity::OutOfTime{};
}

std::vector<PhaseReport> Phases::finish() {
  close();
  return std::exchange(phases_, {});
}

}  // namespace gltf_radiosity
