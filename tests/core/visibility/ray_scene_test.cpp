#include "core/visibility/ray_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "core/parallel.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

/// Half of the least normal number, or 0 where denormal numbers are flushed.
float a_denormal_number() {
  volatile float least = std::numeric_limits<float>::min();
  return least * 0.5F;
}

TEST(RayScene, LeavesDenormalNumbersWhatTheyAre) {
  const Scene scene = test::occluder();
  const RayScene rays(scene);
  EXPECT_GT(a_denormal_number(), 0.0F);
  std::vector<float> numbers(1000, 0.0F);
  in_parallel(0, numbers.size(), [&](std::size_t k) { numbers[k] = a_denormal_number(); });
  EXPECT_TRUE(std::all_of(numbers.begin(), numbers.end(), [](float number) { return number > 0.0F; }));
}

}  // namespace
}  // namespace radiosity
