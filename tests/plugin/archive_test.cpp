#include "plugin/archive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <glm/vec3.hpp>
#include <numeric>

#include "plugin/archive_format.h"
#include "plugin/archive_writer.h"
#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr ArchiveKind kKind{"test", 3};

std::vector<std::uint32_t> numbers() {
  std::vector<std::uint32_t> numbers(100);
  std::iota(numbers.begin(), numbers.end(), 0U);
  return numbers;
}

/// An archive with a chunk of each sort.
void write_sample(const std::filesystem::path& file) {
  const std::vector<glm::vec3> points{{1.0F, 2.0F, 3.0F}, {4.0F, 5.0F, 6.0F}};
  const std::vector<float> none;
  ArchiveWriter writer(kKind);
  writer.add("points", points, Packing::kPlain);
  writer.add("numbers", numbers(), Packing::kZstd);
  writer.add("none", none, Packing::kZstd);
  writer.add_value("answer", 42.5);
  writer.add_text("names", "lamp\nsky");
  ASSERT_TRUE(writer.write(file));
}

/// All that write_sample() puts into the archive is there; answers what is wrong, or nothing.
std::string wrong_with_sample(const std::filesystem::path& file) {
  const Result<Archive> archive = Archive::open(file, kKind);
  if (!archive) return archive.error().text();
  const auto points = archive->read<glm::vec3>("points");
  if (!points) return points.error().text();
  const auto read_numbers = archive->read_vector<std::uint32_t>("numbers");
  if (!read_numbers) return read_numbers.error().text();
  const auto none = archive->read<float>("none");
  if (!none) return none.error().text();
  const auto answer = archive->read_value<double>("answer");
  if (!answer) return answer.error().text();
  const auto names = archive->read_text("names");
  if (!names) return names.error().text();
  const bool same = points->values.size() == 2 && points->values[1] == glm::vec3(4.0F, 5.0F, 6.0F) &&
                    *read_numbers == numbers() && none->values.empty() && *answer == 42.5 && *names == "lamp\nsky";
  return same ? "" : "other values";
}

/// The bytes of an archive as they were written, to be changed.
class ArchiveBytes : public testing::Test {
 protected:
  void SetUp() override {
    write_sample(file_);
    bytes_ = read_text(file_);
  }

  std::string wrong_with(const std::string& bytes) {
    write_text(file_, bytes);
    return wrong_with_sample(file_);
  }
  archive_format::Header header() const {
    archive_format::Header header;
    std::memcpy(&header, bytes_.data(), sizeof(header));
    return header;
  }

  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "archive";
  std::string bytes_;
};

TEST(Archive, GivesBackWhatWasWritten) {
  const TemporaryFolder folder;
  write_sample(folder / "archive");
  EXPECT_EQ(wrong_with_sample(folder / "archive"), "");
  EXPECT_THAT(names_in(folder.path()), ElementsAre("archive"));
}

TEST(Archive, PackedIsSmallerAndPlainIsAligned) {
  const TemporaryFolder folder;
  const std::vector<std::uint64_t> zeros(100'000, 0);
  ArchiveWriter writer(kKind);
  writer.add_text("one byte", "x");
  writer.add("plain", zeros, Packing::kPlain);
  ASSERT_TRUE(writer.write(folder / "plain"));
  ArchiveWriter packing(kKind);
  packing.add("packed", zeros, Packing::kZstd);
  ASSERT_TRUE(packing.write(folder / "packed"));

  const Result<Archive> archive = Archive::open(folder / "plain", kKind);
  ASSERT_TRUE(archive);
  const auto chunk = archive->read<std::uint64_t>("plain");
  ASSERT_TRUE(chunk);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(chunk->values.data()) % 64, 0U);
  EXPECT_LT(std::filesystem::file_size(folder / "packed"), 1000U);
  const auto unpacked = Archive::open(folder / "packed", kKind)->read_vector<std::uint64_t>("packed");
  ASSERT_TRUE(unpacked);
  EXPECT_EQ(*unpacked, zeros);
}

TEST(Archive, ChunksOutliveTheArchiveAndTheFile) {
  const TemporaryFolder folder;
  write_sample(folder / "archive");
  Chunk<glm::vec3> points;
  {
    const Result<Archive> archive = Archive::open(folder / "archive", kKind);
    ASSERT_TRUE(archive);
    points = archive->read<glm::vec3>("points").value();
  }
  std::filesystem::remove(folder / "archive");
  EXPECT_THAT(points.values, ElementsAre(glm::vec3(1.0F, 2.0F, 3.0F), glm::vec3(4.0F, 5.0F, 6.0F)));
}

TEST(Archive, TheSameChunksGiveTheSameBytes) {
  const TemporaryFolder folder;
  write_sample(folder / "a");
  write_sample(folder / "b");
  EXPECT_EQ(read_text(folder / "a"), read_text(folder / "b"));
}

TEST(Archive, AsksForTheRightValues) {
  const TemporaryFolder folder;
  write_sample(folder / "archive");
  const Result<Archive> archive = Archive::open(folder / "archive", kKind);
  ASSERT_TRUE(archive);
  EXPECT_TRUE(archive->holds("points"));
  EXPECT_FALSE(archive->holds("nothing"));
  EXPECT_THAT(archive->read<float>("nothing").error().text(), HasSubstr("archive: chunk 'nothing' is missing"));
  EXPECT_THAT(archive->read<float>("points").error().text(), HasSubstr("values have 12 bytes instead of 4"));
  EXPECT_THAT(archive->read_value<glm::vec3>("points").error().text(), HasSubstr("more or less than one value"));
}

TEST(Archive, WhatIsNoFileOfOursIsRefused) {
  const TemporaryFolder folder;
  EXPECT_THAT(Archive::open(folder / "none", kKind).error().text(), HasSubstr("none: cannot be read: No such file"));
  EXPECT_THAT(Archive::open(folder.path(), kKind).error().text(), HasSubstr("cannot be read: is not a file"));
  write_text(folder / "empty", "");
  EXPECT_THAT(Archive::open(folder / "empty", kKind).error().text(), HasSubstr("is no file of this program"));
  write_text(folder / "text", std::string(500, 'x'));
  EXPECT_THAT(Archive::open(folder / "text", kKind).error().text(), HasSubstr("is no file of this program"));
}

TEST(Archive, AnotherKindOrVersionIsRefused) {
  const TemporaryFolder folder;
  write_sample(folder / "archive");
  EXPECT_THAT(Archive::open(folder / "archive", {"test", 4}).error().text(),
              HasSubstr("is 'test' of version 3; 'test' of version 4 is wanted"));
  EXPECT_THAT(Archive::open(folder / "archive", {"tests", 3}).error().text(),
              HasSubstr("'tests' of version 3 is wanted"));
}

TEST_F(ArchiveBytes, AnotherFormatIsRefused) {
  std::string other = bytes_;
  other[offsetof(archive_format::Header, version)] = 9;
  EXPECT_THAT(wrong_with(other), HasSubstr("is an archive of version 9; this program reads version 1"));
}

TEST_F(ArchiveBytes, AnotherByteOrderIsRefused) {
  std::string other = bytes_;
  const auto order = other.begin() + offsetof(archive_format::Header, byte_order);
  std::reverse(order, order + 4);
  EXPECT_THAT(wrong_with(other), HasSubstr("comes from a machine of another byte order"));
}

TEST_F(ArchiveBytes, EveryTruncationIsFound) {
  for (std::size_t size = 0; size < bytes_.size(); ++size) {
    ASSERT_THAT(wrong_with(bytes_.substr(0, size)), testing::AnyOf(HasSubstr("is cut off"), HasSubstr("no file of")))
        << size;
  }
  EXPECT_THAT(wrong_with(bytes_ + "x"), HasSubstr("is cut off"));
}

TEST_F(ArchiveBytes, EveryFlippedByteIsFoundUnlessItIsPadding) {
  std::size_t harmless = 0;
  for (std::size_t i = 0; i < bytes_.size(); ++i) {
    std::string flipped = bytes_;
    flipped[i] = static_cast<char>(flipped[i] ^ 0x10);
    const std::string wrong = wrong_with(flipped);
    ASSERT_NE(wrong, "other values") << i;
    if (!wrong.empty()) continue;
    ASSERT_EQ(bytes_[i], 0) << i;
    ++harmless;
  }
  EXPECT_LT(harmless, 64U * 7U);  // behind the header and each chunk, up to the next multiple of 64
}

TEST_F(ArchiveBytes, ADamagedChunkIsNamed) {
  const std::size_t at = bytes_.find("lamp\nsky");
  ASSERT_NE(at, std::string::npos);
  bytes_[at] = 'L';
  EXPECT_THAT(wrong_with(bytes_), HasSubstr("chunk 'names' is damaged: its checksum is wrong"));
}

}  // namespace
}  // namespace gltf_radiosity
