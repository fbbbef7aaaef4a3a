#include "core/progress.h"

#include <gtest/gtest.h>

namespace radiosity {
namespace {

TEST(Pace, WithoutALimitThereIsAlwaysTime) {
  const Progress progress;
  EXPECT_FALSE(progress.is_short_of(1e9));
  Pace pace(progress, 1e9);
  EXPECT_TRUE(pace.allows_another_step());
}

TEST(Pace, AStepMustFitIntoWhatIsLeft) {
  double left = 10.0;
  const Progress progress{.report = {}, .cancelled = {}, .seconds_left = [&left] { return left; }};
  Pace pace(progress, 2.0);
  left = 8.0;  // a step of two seconds
  EXPECT_TRUE(pace.allows_another_step());
  left = 5.0;  // one of three: the next might end at 1.1
  EXPECT_FALSE(pace.allows_another_step());
  left = 4.9;
  EXPECT_TRUE(pace.allows_another_step());
  left = 1.9;
  EXPECT_FALSE(pace.allows_another_step());
}

}  // namespace
}  // namespace radiosity
