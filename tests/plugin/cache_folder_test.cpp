#include "plugin/cache_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr ArchiveKind kNumbers{"numbers", 1};
constexpr std::uint64_t kPlenty = std::uint64_t{1} << 40U;

class CacheFolderTest : public testing::Test {
 protected:
  CacheFolder cache(std::uint64_t max_bytes = kPlenty) {
    return CacheFolder::open(folder_ / "cache", max_bytes, warnings_).value();
  }
  /// Entries of about 10 kB.
  void store(CacheFolder cache, const std::string& hash, double value) {
    const std::vector<double> values(1250, value);
    ArchiveWriter entry(kNumbers);
    entry.add("values", values, Packing::kPlain);
    cache.store(kNumbers, hash, entry);
  }
  std::optional<double> load(const CacheFolder& cache, const std::string& hash) {
    const auto values =
        cache.load(kNumbers, hash, [](const Archive& archive) { return archive.read_vector<double>("values"); });
    return values ? std::optional(values->front()) : std::nullopt;
  }
  fs::path entry(const std::string& hash) const { return folder_ / "cache" / ("numbers-" + hash + ".radcache"); }
  void was_used(const std::string& hash, std::chrono::hours ago) const {
    fs::last_write_time(entry(hash), fs::file_time_type::clock::now() - ago);
  }

  const TemporaryFolder folder_;
  std::vector<Warning> warnings_;
};

TEST_F(CacheFolderTest, GivesBackWhatWasStoredUnderTheSameHash) {
  EXPECT_EQ(load(cache(), "a"), std::nullopt);
  store(cache(), "a", 1.5);
  EXPECT_EQ(load(cache(), "a"), 1.5);
  EXPECT_EQ(load(cache(), "b"), std::nullopt);
  EXPECT_THAT(warnings_, IsEmpty());
}

TEST_F(CacheFolderTest, ADamagedEntryIsAWarningAndIsReplaced) {
  store(cache(), "a", 1.5);
  std::string bytes = read_text(entry("a"));
  bytes[1000] = static_cast<char>(bytes[1000] ^ 1);
  write_text(entry("a"), bytes);
  EXPECT_EQ(load(cache(), "a"), std::nullopt);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_EQ(warnings_[0].code, "cache-damaged");
  EXPECT_EQ(warnings_[0].place, entry("a").string());
  EXPECT_THAT(warnings_[0].message,
              HasSubstr("chunk 'values' is damaged: its checksum is wrong; it is computed again"));
  store(cache(), "a", 2.5);
  EXPECT_EQ(load(cache(), "a"), 2.5);
}

TEST_F(CacheFolderTest, WhatIsNoArchiveAtAllIsAWarningToo) {
  store(cache(), "a", 1.5);
  for (const char* text : {"", "garbage"}) {
    write_text(entry("a"), text);
    warnings_.clear();
    EXPECT_EQ(load(cache(), "a"), std::nullopt);
    ASSERT_EQ(warnings_.size(), 1U);
    EXPECT_EQ(warnings_[0].code, "cache-damaged");
  }
}

TEST_F(CacheFolderTest, WhatWasUsedLongestAgoGoesFirst) {
  for (const char* hash : {"a", "b", "c"}) store(cache(), hash, 1.0);
  was_used("a", std::chrono::hours(3));
  was_used("b", std::chrono::hours(2));
  was_used("c", std::chrono::hours(1));
  EXPECT_TRUE(load(cache(), "a"));  // used now: b is the oldest
  store(cache(35'000), "d", 1.0);
  EXPECT_THAT(names_in(folder_ / "cache"),
              ElementsAre("numbers-a.radcache", "numbers-c.radcache", "numbers-d.radcache"));
}

TEST_F(CacheFolderTest, OnlyItsOwnFilesGo) {
  fs::create_directory(folder_ / "cache");
  write_text(folder_ / "cache/precious.glb", std::string(100'000, 'x'));
  store(cache(15'000), "a", 1.0);
  was_used("a", std::chrono::hours(1));
  store(cache(15'000), "b", 1.0);
  EXPECT_THAT(names_in(folder_ / "cache"), ElementsAre("numbers-b.radcache", "precious.glb"));
}

TEST_F(CacheFolderTest, TemporaryFilesOfTheDeadGoAfterADay) {
  fs::create_directory(folder_ / "cache");
  const auto temporary = [&](const std::string& name) { return folder_ / "cache" / name; };
  write_text(temporary(".numbers-x.radcache.tmp-1-0"), "old");
  write_text(temporary(".numbers-y.radcache.tmp-2-0"), "new");
  fs::last_write_time(temporary(".numbers-x.radcache.tmp-1-0"),
                      fs::file_time_type::clock::now() - std::chrono::hours(25));
  store(cache(), "a", 1.0);
  EXPECT_THAT(names_in(folder_ / "cache"), ElementsAre(".numbers-y.radcache.tmp-2-0", "numbers-a.radcache"));
}

TEST_F(CacheFolderTest, AFolderThatCannotBeUsedIsAnError) {
  write_text(folder_ / "file", "");
  const auto opened = CacheFolder::open(folder_ / "file", kPlenty, warnings_);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::kCannotWrite);
}

TEST_F(CacheFolderTest, WhatCannotBeStoredIsAWarning) {
  CacheFolder there = cache();
  fs::create_directory(entry("a"));
  store(there, "a", 1.0);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_EQ(warnings_[0].code, "cache-not-written");
}

}  // namespace
}  // namespace gltf_radiosity
