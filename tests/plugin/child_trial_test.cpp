#include "plugin/child_trial.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <stdexcept>

namespace gltf_radiosity {
namespace {

TEST(ChildTrial, LeavesNoTraceHere) {
  int number = 1;
  EXPECT_EQ(try_in_child([&number] { number = 2; }, 1), TrialEnd::kWell);
  EXPECT_EQ(number, 1);
}

TEST(ChildTrial, TellsACrashFromAnEnd) {
  EXPECT_EQ(try_in_child([] { std::abort(); }, 1), TrialEnd::kCrashed);
  EXPECT_EQ(try_in_child([] { throw std::runtime_error("broken"); }, 1), TrialEnd::kCrashed);
}

TEST(ChildTrial, EndsWhatDoesNotEndByItself) {
  const auto forever = [] {
    for (std::atomic<unsigned> k{0};; ++k) {
    }
  };
  EXPECT_EQ(try_in_child(forever, 1), TrialEnd::kTooLong);
}

}  // namespace
}  // namespace gltf_radiosity
