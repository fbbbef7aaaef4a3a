// How a long computation tells its caller where it is, and how the caller stops it.
#pragma once

#include <functional>
#include <string_view>

namespace radiosity {

/// Thrown by core when Progress::cancelled answers true; nothing else is thrown on purpose.
struct Cancelled {};

/// Callbacks of a long computation. Both may be empty; both are called from one thread at a time.
struct Progress {
  /// `phase` is one of a few fixed words ("subdivide", "solve", "gather", ...); `done` runs from 0 to 1 in each phase.
  std::function<void(std::string_view phase, double done)> report;
  /// Asked every few milliseconds; answering true ends the computation with `Cancelled`.
  std::function<bool()> cancelled;

  /// Reports and then throws `Cancelled` if the caller wants to stop.
  void update(std::string_view phase, double done) const;
};

}  // namespace radiosity
