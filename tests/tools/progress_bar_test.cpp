#include "tools/progress_bar.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace gltf_radiosity::tools {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const std::string kClear = "\r\x1b[K";

/// A terminal whose clock and width the test sets.
struct Terminal {
  std::string text;
  std::vector<std::string> writes;
  int width = 80;
  double seconds = 0.0;

  ProgressBar::Surroundings surroundings() {
    return {[this](std::string_view written) {
              text += written;
              writes.emplace_back(written);
            },
            [this] { return width; },
            [this] {
              return ProgressBar::Clock::time_point(
                  std::chrono::duration_cast<ProgressBar::Clock::duration>(std::chrono::duration<double>(seconds)));
            }};
  }

  /// What stands on the line now.
  std::string line() const {
    const std::size_t clear = text.rfind(kClear);
    return clear == std::string::npos ? text : text.substr(clear + kClear.size());
  }
};

TEST(ProgressBar, ShowsPhaseShareAndTimeLeft) {
  Terminal terminal;
  ProgressBar bar(ProgressStyle::kBar, terminal.surroundings());
  bar.update("solve", 0.0);
  EXPECT_THAT(terminal.line(), AllOf(StartsWith("solve "), EndsWith("   0 %"), Not(HasSubstr("left"))));
  terminal.seconds = 8.0;
  bar.update("solve", 0.4);
  EXPECT_THAT(terminal.line(), AllOf(StartsWith("solve "), HasSubstr(" 40 %"), EndsWith("0:12 left")));
}

TEST(ProgressBar, FillsInProportion) {
  Terminal terminal;
  ProgressBar bar(ProgressStyle::kBar, terminal.surroundings());
  bar.update("a", 0.0);
  const auto cells = std::ranges::count(terminal.line(), '-');
  EXPECT_GE(cells, 8);
  terminal.seconds += 1.0;
  bar.update("a", 0.5);
  EXPECT_EQ(std::ranges::count(terminal.line(), '#'), cells / 2);
  terminal.seconds += 1.0;
  bar.update("a", 1.0);
  EXPECT_EQ(std::ranges::count(terminal.line(), '#'), cells);
}

TEST(ProgressBar, NeverReachesTheLastColumn) {
  for (int width = 1; width < 200; ++width) {
    Terminal terminal;
    terminal.width = width;
    ProgressBar bar(ProgressStyle::kBar, terminal.surroundings());
    bar.update("subdivide", 0.0);
    terminal.seconds = 3600.0;
    bar.update("subdivide", 0.021);
    EXPECT_LE(terminal.line().size(), static_cast<std::size_t>(std::max(width - 1, 1)));
    EXPECT_FALSE(terminal.line().empty());
  }
}

TEST(ProgressBar, FollowsTheWidthOfTheTerminal) {
  Terminal terminal;
  ProgressBar bar(ProgressStyle::kBar, terminal.surroundings());
  bar.update("solve", 0.5);
  EXPECT_THAT(terminal.line(), HasSubstr("["));
  terminal.width = 20;
  terminal.seconds = 1.0;
  bar.update("solve", 0.5);
  EXPECT_EQ(terminal.line(), "solve 50%");
}

TEST(ProgressBar, IsRedrawnAtMostTenTimesASecond) {
  Terminal terminal;
  ProgressBar bar(ProgressStyle::kBar, terminal.surroundings());
  for (int i = 0; i <= 10'000; ++i) {
    terminal.seconds = i / 10'000.0;
    bar.update(i < 5000 ? "solve" : "gather", i / 10'000.0);
  }
  EXPECT_LE(terminal.writes.size(), 11U);
  EXPECT_GE(terminal.writes.size(), 9U);
}

TEST(ProgressBar, IsClearedAtTheEnd) {
  Terminal terminal;
  {
    ProgressBar bar(ProgressStyle::kBar, terminal.surroundings());
    bar.update("solve", 0.5);
    bar.finish();
    EXPECT_EQ(terminal.line(), "");
    bar.update("write", 0.5);
  }
  EXPECT_EQ(terminal.line(), "");
  EXPECT_EQ(terminal.text.find('\n'), std::string::npos);
}

TEST(ProgressBar, SurvivesSharesThatAreNone) {
  Terminal terminal;
  ProgressBar bar(ProgressStyle::kBar, terminal.surroundings());
  for (const double done :
       {-1.0, 2.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    terminal.seconds += 10.0;
    bar.update("solve", done);
    EXPECT_THAT(terminal.line(), testing::AnyOf(HasSubstr("  0 %"), HasSubstr("100 %")));
  }
}

TEST(PlainProgress, SaysWhenAPhaseStartsAndEnds) {
  Terminal terminal;
  ProgressBar lines(ProgressStyle::kPlain, terminal.surroundings());
  lines.update("read", 0.0);
  lines.update("read", 0.5);
  terminal.seconds = 0.25;
  lines.update("read", 1.0);
  lines.update("read", 1.0);
  lines.update("solve", 0.0);
  terminal.seconds = 2.0;
  lines.update("write", 0.0);
  terminal.seconds = 2.5;
  lines.finish();
  EXPECT_EQ(terminal.text,
            "read: started\nread: done in 0.25 s\nsolve: started\nsolve: done in 1.75 s\nwrite: started\n"
            "write: done in 0.50 s\n");
}

TEST(PlainProgress, DoesNotCallAnAbandonedPhaseDone) {
  Terminal terminal;
  {
    ProgressBar lines(ProgressStyle::kPlain, terminal.surroundings());
    lines.update("solve", 0.5);
    lines.abandon();
  }
  EXPECT_EQ(terminal.text, "solve: started\n");
}

TEST(PlainProgress, GivesASignOfLifeInLongPhases) {
  Terminal terminal;
  ProgressBar lines(ProgressStyle::kPlain, terminal.surroundings());
  lines.update("solve", 0.0);
  terminal.seconds = 29.0;
  lines.update("solve", 0.2);
  EXPECT_EQ(terminal.writes.size(), 1U);
  terminal.seconds = 30.0;
  lines.update("solve", 0.25);
  EXPECT_EQ(terminal.writes.back(), "solve: 25 %, 1:30 left\n");
}

TEST(PlainProgress, HoldsNoControlCharacters) {
  Terminal terminal;
  ProgressBar lines(ProgressStyle::kPlain, terminal.surroundings());
  lines.update("solve", 0.0);
  lines.update("solve", 1.0);
  lines.finish();
  EXPECT_THAT(terminal.text, AllOf(Not(HasSubstr("\r")), Not(HasSubstr("\x1b"))));
}

TEST(NoProgress, WritesNothing) {
  Terminal terminal;
  ProgressBar none(ProgressStyle::kNone, terminal.surroundings());
  none.update("solve", 0.5);
  none.update("write", 1.0);
  none.finish();
  EXPECT_EQ(terminal.text, "");
}

TEST(FormatDuration, RoundsUpToWholeSeconds) {
  EXPECT_EQ(format_duration(0.0), "0:00");
  EXPECT_EQ(format_duration(0.1), "0:01");
  EXPECT_EQ(format_duration(59.5), "1:00");
  EXPECT_EQ(format_duration(750.0), "12:30");
  EXPECT_EQ(format_duration(3723.0), "1:02:03");
  EXPECT_EQ(format_duration(1e30), "168:00:00");
}

}  // namespace
}  // namespace gltf_radiosity::tools
