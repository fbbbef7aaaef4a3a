// What people see while a bake runs: one line that is redrawn, or one line per phase.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>

#include "tools/command_line.h"

namespace gltf_radiosity::tools {

/// Shows the phases of a bake, as Callbacks::progress reports them.
///
/// Called from one thread at a time. The bar is redrawn at most ten times a second, so that update() may be called
/// often.
class ProgressBar {
 public:
  using Clock = std::chrono::steady_clock;

  /// What the display stands on; tests put a string and a clock of their own here.
  struct Surroundings {
    std::function<void(std::string_view text)> write;  ///< takes text, control characters included
    std::function<int()> width;                        ///< columns of the terminal, asked at each redraw
    std::function<Clock::time_point()> now;
  };

  /// REQUIRES: `style` is not kAuto.
  ProgressBar(ProgressStyle style, Surroundings surroundings);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  /// Clears the bar.
  ~ProgressBar();

  /// `phase` is `done`, in [0,1]; a new name ends the phase before.
  void update(std::string_view phase, double done);

  /// The last phase ended well: clears the bar, or says how long it took.
  void finish();

  /// The last phase did not end: clears the bar and says nothing.
  void abandon();

 private:
  void end_phase();
  void draw_bar(Clock::time_point now, double done);
  void write_plain(Clock::time_point now, double done);
  double seconds_in_phase(Clock::time_point now) const;

  ProgressStyle style_;
  Surroundings surroundings_;
  std::string phase_;  ///< empty between phases
  std::string ended_;  ///< the phase that ended last
  Clock::time_point phase_start_;
  Clock::time_point last_output_;
  bool bar_visible_ = false;
};

/// "0:07", "12:30", "1:02:03"; rounded up.
std::string format_duration(double seconds);

/// Columns of the terminal behind stderr; 80 if it does not say.
int terminal_width();

/// What kAuto stands for: a bar if stderr is a terminal that can redraw a line, plain lines otherwise.
ProgressStyle resolve(ProgressStyle style);

/// stderr, its terminal and the steady clock.
ProgressBar::Surroundings standard_error();

}  // namespace gltf_radiosity::tools
