#include "tools/progress_bar.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <utility>

namespace gltf_radiosity::tools {
namespace {

using namespace std::chrono_literals;

constexpr auto kRedrawInterval = 100ms;
constexpr auto kPlainInterval = 30s;  // a sign of life in logs: some build servers stop jobs that stay silent
constexpr std::string_view kClearLine = "\r\x1b[K";
constexpr int kNameColumns = 10;
constexpr int kLeastBarColumns = 8;

/// Seconds left in a phase if it goes on as it went; nothing while that would be a guess.
std::optional<double> time_left(double seconds, double done) {
  constexpr double kLeastSeconds = 1.0;
  constexpr double kLeastShare = 0.02;
  if (seconds < kLeastSeconds || done < kLeastShare) return std::nullopt;
  return seconds * (1.0 - done) / done;
}

int percent_of(double done) { return static_cast<int>(std::floor(100.0 * done)); }

/// solve      [########------------]  40 %  0:12 left
std::string bar_line(std::string_view phase, double done, std::optional<double> left, int width) {
  const std::string name = fmt::format("{:<{}}", phase, kNameColumns);
  const std::string numbers = fmt::format("{:3d} %", percent_of(done));
  const std::string estimate = left ? fmt::format("  {} left", format_duration(*left)) : "";

  // The last column stays empty: a terminal may wrap once it is written
  const std::size_t columns = static_cast<std::size_t>(std::max(width - 1, 1));
  const std::size_t text_columns = name.size() + numbers.size() + std::string_view("  12:30 left").size() + 5;
  if (columns < text_columns + kLeastBarColumns)
    return fmt::format("{} {}%", phase, percent_of(done)).substr(0, columns);

  const std::size_t cells = std::min<std::size_t>(columns - text_columns, 50);
  const auto filled = static_cast<std::size_t>(std::floor(done * static_cast<double>(cells)));
  return fmt::format("{} [{}{}] {}{}", name, std::string(filled, '#'), std::string(cells - filled, '-'), numbers,
                     estimate)
      .substr(0, columns);
}

}  // namespace

ProgressBar::ProgressBar(ProgressStyle style, Surroundings surroundings)
    : style_(style), surroundings_(std::move(surroundings)) {}

ProgressBar::~ProgressBar() { abandon(); }

void ProgressBar::update(std::string_view phase, double done) {
  if (style_ == ProgressStyle::kNone) return;
  const Clock::time_point now = surroundings_.now();
  done = std::isfinite(done) ? std::clamp(done, 0.0, 1.0) : 0.0;

  // A new name ends the phase before and starts the next
  const bool starts = phase != phase_;
  if (starts) {
    if (phase_.empty() && phase == ended_) return;
    end_phase();
    phase_ = phase;
    phase_start_ = now;
    last_output_ = now;
    if (style_ == ProgressStyle::kPlain) surroundings_.write(fmt::format("{}: started\n", phase_));
  }

  if (style_ == ProgressStyle::kPlain) return write_plain(now, done);
  if (!bar_visible_ || now - last_output_ >= kRedrawInterval) draw_bar(now, done);
}

void ProgressBar::finish() {
  end_phase();
  abandon();
}

void ProgressBar::abandon() {
  if (bar_visible_) surroundings_.write(kClearLine);
  bar_visible_ = false;
  phase_.clear();
}

void ProgressBar::end_phase() {
  if (phase_.empty()) return;
  if (style_ == ProgressStyle::kPlain) {
    surroundings_.write(fmt::format("{}: done in {:.2f} s\n", phase_, seconds_in_phase(surroundings_.now())));
  }
  ended_ = std::exchange(phase_, {});
}

void ProgressBar::draw_bar(Clock::time_point now, double done) {
  const std::string line = bar_line(phase_, done, time_left(seconds_in_phase(now), done), surroundings_.width());
  surroundings_.write(std::string(kClearLine) + line);
  bar_visible_ = true;
  last_output_ = now;
}

void ProgressBar::write_plain(Clock::time_point now, double done) {
  if (done >= 1.0) return end_phase();
  if (now - last_output_ < kPlainInterval) return;
  const std::optional<double> left = time_left(seconds_in_phase(now), done);
  const std::string estimate = left ? fmt::format(", {} left", format_duration(*left)) : "";
  surroundings_.write(fmt::format("{}: {} %{}\n", phase_, percent_of(done), estimate));
  last_output_ = now;
}

double ProgressBar::seconds_in_phase(Clock::time_point now) const {
  return std::chrono::duration<double>(now - phase_start_).count();
}

std::string format_duration(double seconds) {
  // Beyond a week the estimate means "very long" and nothing else
  const auto whole = static_cast<long>(std::ceil(std::clamp(seconds, 0.0, 7.0 * 24.0 * 3600.0)));
  if (whole < 3600) return fmt::format("{}:{:02d}", whole / 60, whole % 60);
  return fmt::format("{}:{:02d}:{:02d}", whole / 3600, whole / 60 % 60, whole % 60);
}

int terminal_width() {
  struct winsize size = {};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

ProgressStyle resolve(ProgressStyle style) {
  if (style != ProgressStyle::kAuto) return style;
  const char* const terminal = std::getenv("TERM");
  const bool redraws = terminal != nullptr && std::string_view(terminal) != "dumb";
  return isatty(STDERR_FILENO) != 0 && redraws ? ProgressStyle::kBar : ProgressStyle::kPlain;
}

ProgressBar::Surroundings standard_error() {
  const auto write = [](std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
  };
  return {write, terminal_width, ProgressBar::Clock::now};
}

}  // namespace gltf_radiosity::tools
