#include "core/transport/form_factors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <new>
#include <numeric>
#include <utility>

#include "tests/core/prepared_scene.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

using test::PreparedScene;

double sum(const FormFactorRow& row) {
  return std::accumulate(row.factor.begin(), row.factor.end(), double{row.to_sky} + double{row.to_backs});
}

std::vector<std::uint32_t> surfaces_of_patches(const PreparedScene& s) {
  std::vector<std::uint32_t> surface(s.patches.patch_count(), kNothing);
  for (const Tile& tile : s.patches.tiling.leaves()) {
    surface[s.patches.patch_of_tile[tile.tile]] = s.scene.surface_of_triangle[tile.triangle];
  }
  return surface;
}

/// A_k F_kl between whole surfaces, m2, [from][to], and what reaches none.
struct Exchange {
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> between;
  double to_sky = 0.0, to_backs = 0.0;
};

Exchange exchange(const PreparedScene& s) {
  const std::vector<std::uint32_t> surface = surfaces_of_patches(s);
  Exchange result;
  for (std::uint32_t i = 0; i < s.patches.patch_count(); ++i) {
    const FormFactorRow row = s.rows->row(i);
    const double area = s.patches.area[i];
    for (std::size_t k = 0; k < row.patch.size(); ++k) {
      result.between[{surface[i], surface[row.patch[k]]}] += area * double{row.factor[k]};
    }
    result.to_sky += area * double{row.to_sky};
    result.to_backs += area * double{row.to_backs};
  }
  return result;
}

TEST(FormFactors, SumToOneInAClosedScene) {
  const PreparedScene s(test::white_furnace(0.5F, 1.0F));
  for (std::uint32_t i = 0; i < s.patches.patch_count(); ++i) {
    const FormFactorRow row = s.rows->row(i);
    EXPECT_NEAR(sum(row), 1.0, 1e-5);
    EXPECT_EQ(row.to_sky, 0.0F);
    EXPECT_LT(row.to_backs, 1e-6F);
  }
}

TEST(FormFactors, SumToOneWithSkyAndBacks) {
  const PreparedScene s(test::cornell_box());
  for (std::uint32_t i = 0; i < s.patches.patch_count(); ++i) EXPECT_NEAR(sum(s.rows->row(i)), 1.0, 1e-5);
}

TEST(FormFactors, ArePositiveAndAscend) {
  const PreparedScene s(test::cornell_box());
  for (std::uint32_t i = 0; i < s.patches.patch_count(); ++i) {
    const FormFactorRow row = s.rows->row(i);
    ASSERT_EQ(row.patch.size(), row.factor.size());
    for (const float factor : row.factor) EXPECT_GT(factor, 0.0F);
    EXPECT_EQ(std::adjacent_find(row.patch.begin(), row.patch.end(), std::greater_equal<>()), row.patch.end());
  }
}

TEST(FormFactors, OfTheUnitCubesFacesAreTheKnownOnes) {
  const PreparedScene s(test::unit_cube_faces(), 400, 16);
  const Exchange found = exchange(s);
  for (std::uint32_t k = 0; k < 6; ++k) {
    for (std::uint32_t l = 0; l < 6; ++l) {
      if (k == l) continue;
      const double expected = l == (k ^ 1U) ? 0.199825 : 0.200044;
      EXPECT_NEAR(found.between.at({k, l}) / expected, 1.0, 0.01) << k << " to " << l;
    }
  }
}

TEST(FormFactors, OfParallelSquaresAreTheKnownOnes) {
  const PreparedScene s(test::parallel_squares(1.0F), 150, 16);
  const Exchange found = exchange(s);
  EXPECT_NEAR(found.between.at({0, 1}) / 0.199825, 1.0, 0.01);
  EXPECT_NEAR(found.between.at({1, 0}) / 0.199825, 1.0, 0.01);
  EXPECT_NEAR(found.to_sky, 2.0 * (1.0 - 0.199825), 0.004);
}

TEST(FormFactors, OfPerpendicularSquaresAreTheKnownOnes) {
  const PreparedScene s(test::perpendicular_squares(), 150, 16);
  const Exchange found = exchange(s);
  EXPECT_NEAR(found.between.at({0, 1}) / 0.200044, 1.0, 0.01);
  EXPECT_NEAR(found.between.at({1, 0}) / 0.200044, 1.0, 0.01);
}

TEST(FormFactors, EndOnTheBackOfAOneSidedSurface) {
  Scene scene = test::parallel_squares(1.0F);
  for (std::size_t t = 2; t < 4; ++t) std::swap(scene.triangles[t].y, scene.triangles[t].z);
  const Exchange found = exchange(PreparedScene(scene, 150, 16));
  EXPECT_FALSE(found.between.contains({0, 1}));
  EXPECT_NEAR(found.to_backs / 0.199825, 1.0, 0.01);
}

TEST(FormFactors, ReachTheBackOfATwoSidedSurface) {
  Scene scene = test::parallel_squares(1.0F);
  for (std::size_t t = 2; t < 4; ++t) std::swap(scene.triangles[t].y, scene.triangles[t].z);
  scene.surfaces[1].two_sided = true;
  const PreparedScene s(scene, 300, 16);  // half of them on the side that sees nothing
  double to_the_back = 0.0;
  for (std::uint32_t i = 0; i < s.patches.patch_count(); ++i) {
    if (s.patches.points_of(i)[0].position.z > 0.5F) continue;
    const FormFactorRow row = s.rows->row(i);
    EXPECT_EQ(row.to_backs, 0.0F);
    for (std::size_t k = 0; k < row.patch.size(); ++k) {
      EXPECT_LT(s.patches.points_of(row.patch[k])[0].normal.z, 0.0F);  // the side that looks at square 0
      to_the_back += double{s.patches.area[i] * row.factor[k]};
    }
  }
  EXPECT_NEAR(to_the_back / 0.199825, 1.0, 0.01);
}

// Four hemicubes to a patch say little about one neighbour in the corner; between whole surfaces it evens out (below).
TEST(FormFactors, AreReciprocalInAggregate) {
  for (const Scene& scene : {test::unit_cube_faces(), test::cornell_box(), test::occluder()}) {
    const PreparedScene s(scene, 200, 64);
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> flux;
    double total = 0.0, difference = 0.0;
    for (std::uint32_t i = 0; i < s.patches.patch_count(); ++i) {
      const FormFactorRow row = s.rows->row(i);
      for (std::size_t k = 0; k < row.patch.size(); ++k) {
        const double exchanged = double{s.patches.area[i] * row.factor[k]};
        flux[{i, row.patch[k]}] = exchanged;
        total += exchanged;
      }
    }
    for (const auto& [pair, exchanged] : flux) {
      const auto reverse = flux.find({pair.second, pair.first});
      difference += std::abs(exchanged - (reverse == flux.end() ? 0.0 : reverse->second));
    }
    EXPECT_LT(difference / total, 0.25);  // 0.13, 0.18 and 0.06
  }
}

TEST(FormFactors, AreReciprocalBetweenSurfaces) {
  const Exchange found = exchange(PreparedScene(test::cornell_box(), 500, 32));
  for (const auto& [pair, area] : found.between) {
    if (pair.first == pair.second || area < 0.01) continue;
    EXPECT_NEAR(found.between.at({pair.second, pair.first}) / area, 1.0, 0.02) << pair.first << ", " << pair.second;
  }
}

/// Row i is (i, i + 1): a share of i / 100 goes to the sky.
struct NumberedRows final : RowSource {
  std::uint32_t patch_count() const override { return 50; }
  FormFactorRow row(std::uint32_t patch) const override {
    return {{patch, patch + 1}, {0.25F, 0.5F}, static_cast<float>(patch) / 100.0F, 0.0F};
  }
};

/// Fills item buffers as another maker does, but not the one of call `failing`.
class FailingMaker final : public ItemBufferMaker {
 public:
  FailingMaker(const ItemBufferMaker& maker, int failing) : maker_(maker), calls_left_(failing) {}
  void fill(const Hemicube& hemicube, const Viewpoint& viewpoint, ItemBuffer& items) const override {
    if (--calls_left_ == 0) throw std::bad_alloc();
    maker_.fill(hemicube, viewpoint, items);
  }

 private:
  const ItemBufferMaker& maker_;
  mutable int calls_left_;
};

TEST(FormFactors, ARowThatRunsOutOfMemoryLeavesNothingToTheNextOne) {
  const PreparedScene s(test::white_furnace(0.5F, 1.0F));
  std::uint32_t patch = 0;
  while (s.patches.points_of(patch).size() < 2) ++patch;
  const FailingMaker failing(*s.items, 2);
  const auto rows = make_hemicube_rows(s.patches, s.hemicube, failing, s.sky, surface_offset(s.scene));
  EXPECT_THROW(rows->row(patch), std::bad_alloc);
  const FormFactorRow row = rows->row(patch), sound = s.rows->row(patch);
  EXPECT_EQ(row.patch, sound.patch);
  EXPECT_EQ(row.factor, sound.factor);
}

TEST(RowCache, ComputesEachRowOnceWhileThereIsRoom) {
  const NumberedRows source;
  RowCache cache(source, 1U << 20U);
  for (int pass = 0; pass < 3; ++pass) {
    for (std::uint32_t i = 0; i < 50; ++i) EXPECT_EQ(cache.row(i).patch.front(), i);
  }
  EXPECT_EQ(cache.computed_count(), 50U);
}

TEST(RowCache, FetchesOnlyWhatIsMissing) {
  const NumberedRows source;
  RowCache cache(source, 1U << 20U);
  cache.fetch(std::vector<std::uint32_t>{3, 4, 5});
  cache.fetch(std::vector<std::uint32_t>{4, 5, 6});
  EXPECT_EQ(cache.computed_count(), 4U);
  EXPECT_TRUE(cache.holds(6));
  EXPECT_FALSE(cache.holds(7));
}

TEST(RowCache, KeepsWithinItsBytes) {
  const NumberedRows source;
  const std::size_t row_bytes = source.row(0).bytes();
  RowCache cache(source, 10 * row_bytes);
  for (std::uint32_t i = 0; i < 50; ++i) cache.row(i);
  std::uint32_t held = 0;
  for (std::uint32_t i = 0; i < 50; ++i) held += cache.holds(i) ? 1U : 0U;
  EXPECT_EQ(held, 10U);
}

TEST(RowCache, EvictsWhatWasUsedLongestAgo) {
  const NumberedRows source;
  RowCache cache(source, 3 * source.row(0).bytes());
  for (const std::uint32_t i : {0U, 1U, 2U, 0U, 3U}) cache.row(i);
  EXPECT_TRUE(cache.holds(0));
  EXPECT_FALSE(cache.holds(1));
  EXPECT_TRUE(cache.holds(2));
  EXPECT_TRUE(cache.holds(3));
}

TEST(RowCache, KeepsTheLastBatchHoweverLittleRoomThereIs) {
  const NumberedRows source;
  RowCache cache(source, 1);
  cache.fetch(std::vector<std::uint32_t>{1, 2, 3});
  for (const std::uint32_t i : {1U, 2U, 3U}) EXPECT_TRUE(cache.holds(i));
  EXPECT_EQ(cache.row(7).patch.front(), 7U);
}

TEST(RowCache, GivesEqualRowsAfterEviction) {
  const PreparedScene s(test::cornell_box(), 150, 8);
  RowCache roomy(*s.rows, std::size_t{1} << 30U), tight(*s.rows, 20'000);
  for (int pass = 0; pass < 2; ++pass) {
    for (std::uint32_t i = 0; i < s.patches.patch_count(); ++i) {
      const FormFactorRow &a = roomy.row(i), &b = tight.row(i);
      EXPECT_EQ(a.patch, b.patch);
      EXPECT_EQ(a.factor, b.factor);
      EXPECT_EQ(std::pair(a.to_sky, a.to_backs), std::pair(b.to_sky, b.to_backs));
    }
  }
  EXPECT_EQ(roomy.computed_count(), s.patches.patch_count());
  EXPECT_EQ(tight.computed_count(), 2U * s.patches.patch_count());
}

}  // namespace
}  // namespace radiosity
