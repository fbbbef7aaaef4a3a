#include "core/progress.h"

namespace radiosity {

void Progress::update(std::string_view phase, double done) const {
  if (report) {
    report(phase, done);
  }
  if (cancelled && cancelled()) {
    throw Cancelled{};
  }
}

Pace::Pace(const Progress& progress, double reserved)
    : progress_(progress), reserved_(reserved), left_(progress.seconds_left ? progress.seconds_left() : 0.0) {}

bool Pace::allows_another_step() {
  if (!progress_.seconds_left) return true;
  constexpr double kSlower = 1.3;  // than the step before
  const double left = progress_.seconds_left();
  const double step = left_ - left;
  left_ = left;
  return left > reserved_ + kSlower * step;
}

}  // namespace radiosity
