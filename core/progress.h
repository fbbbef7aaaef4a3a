// How a long computation tells its caller where it is, and how the caller stops it.
#pragma once

#include <functional>
#include <string_view>

namespace radiosity {

/// Thrown by core when Progress::cancelled answers true.
struct Cancelled {};

/// Thrown by core when time is up before there is any light; nothing else is thrown on purpose.
struct OutOfTime {};

/// Callbacks of a long computation. Both may be empty; both are called from one thread at a time.
struct Progress {
  /// `phase` is one of a few fixed words ("subdivide", "solve", "gather", ...); `done` runs from 0 to 1 in each phase.
  std::function<void(std::string_view phase, double done)> report;
  /// Asked every few milliseconds; answering true ends the computation with `Cancelled`.
  std::function<bool()> cancelled;
  /// Seconds that are left for the computation, negative once they are over; it then ends with what it has. Empty: it
  /// takes as many as it needs.
  std::function<double()> seconds_left{};

  /// Whether fewer than so many seconds are left.
  bool is_short_of(double seconds) const { return seconds_left && seconds_left() < seconds; }

  /// Reports and then throws `Cancelled` if the caller wants to stop.
  void update(std::string_view phase, double done) const;
};

/// Whether a loop has time for another step, judged by the one before.
class Pace {
 public:
  /// The loop must leave `reserved` seconds for what comes after it. `progress` must outlive this.
  explicit Pace(const Progress& progress, double reserved = 0.0);

  /// Called between steps.
  bool allows_another_step();

 private:
  const Progress& progress_;
  double reserved_;
  double left_ = 0.0;  ///< when the last step began
};

}  // namespace radiosity
