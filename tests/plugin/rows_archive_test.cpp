#include "plugin/rows_archive.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

using radiosity::FormFactorRow;

/// Rows made of their number.
class MadeUpRows : public radiosity::RowSource {
 public:
  explicit MadeUpRows(std::uint32_t count) : count_(count) {}
  std::uint32_t patch_count() const override { return count_; }
  FormFactorRow row(std::uint32_t patch) const override {
    FormFactorRow row;
    for (std::uint32_t j = patch % 3; j < count_; j += 1 + patch % 5) {
      if (j == patch) continue;
      row.patch.push_back(j);
      row.factor.push_back(0.1F / static_cast<float>(1 + j));
    }
    row.to_sky = 0.25F;
    row.to_backs = 1.0F / static_cast<float>(2 + patch);
    row.sky = {0.1F, 0.2F, static_cast<float>(patch)};
    return row;
  }

 private:
  std::uint32_t count_;
};

/// Writes the rows into a file of `folder` and reads them again.
std::unique_ptr<radiosity::RowSource> through_a_file(const radiosity::RowSource& source,
                                                     const TemporaryFolder& folder) {
  radiosity::RowCache rows(source, std::size_t{1} << 30U);
  std::vector<std::uint32_t> all(source.patch_count());
  std::iota(all.begin(), all.end(), 0U);
  rows.fetch(all);
  EXPECT_TRUE(rows.holds_all());
  ArchiveWriter archive(kRowsArchive);
  add_rows(archive, rows);
  EXPECT_TRUE(archive.write(folder / "rows"));
  auto read = read_rows(Archive::open(folder / "rows", kRowsArchive).value(), source.patch_count());
  EXPECT_TRUE(read);
  return read ? std::move(*read) : nullptr;
}

TEST(RowsArchive, GivesBackTheSameRows) {
  const TemporaryFolder folder;
  for (const std::uint32_t count : {0U, 1U, 2U, 100U}) {
    const MadeUpRows source(count);
    const auto rows = through_a_file(source, folder);
    ASSERT_NE(rows, nullptr);
    ASSERT_EQ(rows->patch_count(), count);
    for (std::uint32_t i = 0; i < count; ++i) {
      const FormFactorRow expected = source.row(i), row = rows->row(i);
      EXPECT_EQ(row.patch, expected.patch) << i;
      EXPECT_EQ(row.factor, expected.factor) << i;
      EXPECT_EQ(row.to_sky, expected.to_sky);
      EXPECT_EQ(row.to_backs, expected.to_backs);
      EXPECT_EQ(row.sky, expected.sky);
    }
  }
}

TEST(RowsArchive, RowsOfAnotherSceneAreRefused) {
  const TemporaryFolder folder;
  through_a_file(MadeUpRows(10), folder);
  EXPECT_FALSE(read_rows(Archive::open(folder / "rows", kRowsArchive).value(), 11));
}

TEST(RowsArchive, RowsThatNamePatchesThatAreNotThereAreRefused) {
  const TemporaryFolder folder;
  const auto is_read = [&](std::uint32_t count, std::uint32_t step) {
    const std::vector<std::uint32_t> counts{count, 0}, steps{step};
    const std::vector<float> factors{0.5F};
    const std::vector<std::array<float, 5>> rest(2);
    ArchiveWriter archive(kRowsArchive);
    archive.add("counts", counts, Packing::kPlain);
    archive.add("steps", steps, Packing::kPlain);
    archive.add("factors", factors, Packing::kPlain);
    archive.add("rest", rest, Packing::kPlain);
    EXPECT_TRUE(archive.write(folder / "rows"));
    return static_cast<bool>(read_rows(Archive::open(folder / "rows", kRowsArchive).value(), 2));
  };
  EXPECT_TRUE(is_read(1, 1));
  EXPECT_FALSE(is_read(1, 2)) << "there are two patches";
  EXPECT_FALSE(is_read(2, 1)) << "there is one factor";
  EXPECT_FALSE(is_read(4'000'000'000U, 1));
}

}  // namespace
}  // namespace gltf_radiosity
