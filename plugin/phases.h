// How long each phase of a bake takes and how much memory the process has used by its end.
#pragma once

#include <chrono>
#include <string_view>
#include <vector>

#include "core/progress.h"
#include "plugin/gltf_radiosity.h"

namespace gltf_radiosity {

/// Passes progress on to the caller and watches the clock on the way. Must outlive the Progress it hands out.
class Phases {
 public:
  /// After `time_limit` seconds from now core is told that time is up, a little earlier, so that writing is over by
  /// then; before there is any light radiosity::OutOfTime is thrown. 0: there is no limit.
  explicit Phases(const Callbacks& callbacks, double time_limit = 0.0);
  Phases(const Phases&) = delete;
  Phases& operator=(const Phases&) = delete;

  /// For core and for the phases of this library; update() throws radiosity::Cancelled.
  const radiosity::Progress& progress() const { return progress_; }

  /// Ends the last phase; every phase once, in the order they began.
  std::vector<PhaseReport> finish();

 private:
  using Clock = std::chrono::steady_clock;

  void report(std::string_view phase, double done);
  void close();
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  double seconds_to_write() const;

  const Callbacks& callbacks_;
  radiosity::Progress progress_;
  std::vector<PhaseReport> phases_;
  std::size_t current_ = 0;  ///< index into phases_
  Clock::time_point start_ = Clock::now(), since_ = start_;
  double time_limit_;
};

}  // namespace gltf_radiosity
