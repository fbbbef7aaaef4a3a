#include "core/transport/exchange_checks.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "tests/core/prepared_scene.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

/// Rows as they are told.
class ToldRows final : public RowSource {
 public:
  explicit ToldRows(std::vector<FormFactorRow> rows) : rows_(std::move(rows)) {}
  std::uint32_t patch_count() const override { return static_cast<std::uint32_t>(rows_.size()); }
  FormFactorRow row(std::uint32_t patch) const override { return rows_[patch]; }

 private:
  std::vector<FormFactorRow> rows_;
};

ExchangeChecks checks_of(const std::vector<float>& area, std::vector<FormFactorRow> told, bool fetch_all = true) {
  Patches patches;
  patches.area = area;
  const ToldRows source(std::move(told));
  RowCache rows(source, std::size_t{1} << 20U);
  std::vector<std::uint32_t> order(fetch_all ? area.size() : std::size_t{1});
  std::iota(order.begin(), order.end(), 0U);
  rows.fetch(order);
  return check_exchange(patches, rows);
}

TEST(ExchangeChecks, FindNothingWrongWithPerfectRows) {
  const ExchangeChecks checks = checks_of({1, 2}, {{{1}, {0.5F}, 0.5F, 0.0F}, {{0}, {0.25F}, 0.5F, 0.25F}});
  EXPECT_NEAR(checks.closure_error, 0.0, 1e-7);
  EXPECT_NEAR(checks.reciprocity_error, 0.0, 1e-7);
}

TEST(ExchangeChecks, FindARowThatDoesNotSumToOne) {
  const ExchangeChecks checks = checks_of({1, 2}, {{{1}, {0.5F}, 0.4F, 0.0F}, {{0}, {0.25F}, 0.5F, 0.25F}});
  EXPECT_NEAR(checks.closure_error, 0.1, 1e-6);
}

TEST(ExchangeChecks, FindAnExchangeThatIsNotTheSameBothWays) {
  // 0.5 there, 0.3 back: 0.2 of a mean of 0.4.
  const ExchangeChecks checks = checks_of({1, 1}, {{{1}, {0.5F}, 0.5F, 0.0F}, {{0}, {0.3F}, 0.7F, 0.0F}});
  EXPECT_NEAR(checks.reciprocity_error, 0.5, 1e-6);
}

TEST(ExchangeChecks, LeaveReciprocityOutWhereRowsAreMissing) {
  const ExchangeChecks checks = checks_of({1, 1}, {{{1}, {0.5F}, 0.5F, 0.0F}, {{0}, {0.3F}, 0.7F, 0.0F}}, false);
  EXPECT_EQ(checks.reciprocity_error, 0.0);
}

TEST(ExchangeChecks, AreSmallInRealScenes) {
  for (const Scene& scene : {test::box_room({1, 2, 3}, {}), test::cornell_box()}) {
    const test::PreparedScene s(scene, 1000);
    RowCache rows(*s.rows, std::size_t{1} << 28U);
    std::vector<std::uint32_t> all(s.patches.patch_count());
    std::iota(all.begin(), all.end(), 0U);
    rows.fetch(all);
    const ExchangeChecks checks = check_exchange(s.patches, rows);
    EXPECT_LT(checks.closure_error, 1e-5);
    EXPECT_LT(checks.reciprocity_error, 0.1);
    EXPECT_GT(checks.reciprocity_error, 0.0);
  }
}

TEST(ExchangeChecks, AreNoneWithoutPatches) {
  const ExchangeChecks checks = checks_of({}, {});
  EXPECT_EQ(checks.closure_error, 0.0);
  EXPECT_EQ(checks.reciprocity_error, 0.0);
}

}  // namespace
}  // namespace radiosity
