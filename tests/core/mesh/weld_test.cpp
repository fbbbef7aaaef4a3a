#include "core/mesh/weld.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace radiosity {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Weld, GroupsVerticesAtOnePosition) {
  const std::vector<glm::vec3> positions = {{1, 2, 3}, {4, 5, 6}, {1, 2, 3}, {4, 5, 6}, {1, 2, 3}};
  const Weld result = weld(positions);
  EXPECT_EQ(result.class_count, 2U);
  EXPECT_THAT(result.class_of_vertex, ElementsAre(0, 1, 0, 1, 0));
}

TEST(Weld, NumbersClassesByFirstAppearance) {
  const std::vector<glm::vec3> positions = {{9, 0, 0}, {1, 0, 0}, {9, 0, 0}, {5, 0, 0}};
  EXPECT_THAT(weld(positions).class_of_vertex, ElementsAre(0, 1, 0, 2));
}

TEST(Weld, TakesNegativeZeroForZero) {
  const std::vector<glm::vec3> positions = {{0.0F, -0.0F, 1.0F}, {-0.0F, 0.0F, 1.0F}};
  EXPECT_EQ(weld(positions).class_count, 1U);
}

TEST(Weld, HasNoTolerance) {
  const std::vector<glm::vec3> positions = {{1.0F, 0, 0}, {1.0F + 1.2e-7F, 0, 0}};
  EXPECT_EQ(weld(positions).class_count, 2U);
}

TEST(Weld, KeepsCoordinatesApartThatDifferInTheirOrderOnly) {
  const std::vector<glm::vec3> positions = {{1, 2, 3}, {3, 2, 1}, {2, 1, 3}};
  EXPECT_EQ(weld(positions).class_count, 3U);
}

TEST(Weld, AcceptsNothing) {
  const Weld result = weld({});
  EXPECT_EQ(result.class_count, 0U);
  EXPECT_THAT(result.class_of_vertex, IsEmpty());
}

TEST(Weld, FindsEveryClassOfALargeGridStoredTwice) {
  std::vector<glm::vec3> positions;
  for (int copy = 0; copy < 2; ++copy) {
    for (int i = 0; i < 100'000; ++i) {
      const int row = i / 316;
      positions.emplace_back(static_cast<float>(i % 316) * 0.01F, 0.0F, static_cast<float>(row) * 0.01F);
    }
  }
  const Weld result = weld(positions);
  ASSERT_EQ(result.class_count, 100'000U);
  for (std::uint32_t i = 0; i < 100'000; ++i) {
    ASSERT_EQ(result.class_of_vertex[i], i);
    ASSERT_EQ(result.class_of_vertex[i + 100'000], i);
  }
}

}  // namespace
}  // namespace radiosity
