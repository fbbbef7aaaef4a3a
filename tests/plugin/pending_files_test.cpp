#include "plugin/pending_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::span<const std::uint8_t> bytes_in(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

TEST(PendingFiles, NothingAppearsBeforeTheEnd) {
  const TemporaryFolder folder;
  PendingFiles files(folder / "a");
  ASSERT_TRUE(files.add(folder / "a", std::string_view("one")));
  ASSERT_TRUE(files.add(folder / "b", std::string_view("two")));
  EXPECT_FALSE(std::filesystem::exists(folder / "a"));
  ASSERT_TRUE(files.commit());
  EXPECT_THAT(names_in(folder.path()), ElementsAre("a", "b"));
  EXPECT_EQ(read_text(folder / "a"), "one");
  EXPECT_EQ(read_text(folder / "b"), "two");
}

TEST(PendingFiles, WhatIsNotCommittedLeavesNothing) {
  const TemporaryFolder folder;
  {
    PendingFiles files(folder / "a");
    ASSERT_TRUE(files.add(folder / "deep/down/a", std::string_view("one")));
  }
  EXPECT_THAT(names_in(folder.path()), IsEmpty());
}

TEST(PendingFiles, FoldersAreMade) {
  const TemporaryFolder folder;
  PendingFiles files(folder / "a");
  ASSERT_TRUE(files.add(folder / "deep/down/a", std::string_view("one")));
  ASSERT_TRUE(files.commit());
  EXPECT_EQ(read_text(folder / "deep/down/a"), "one");
}

TEST(PendingFiles, AnOldFileIsReplaced) {
  const TemporaryFolder folder;
  write_text(folder / "a", "something longer than the new text");
  PendingFiles files(folder / "a");
  ASSERT_TRUE(files.add(folder / "a", std::string_view("new")));
  ASSERT_TRUE(files.commit());
  EXPECT_EQ(read_text(folder / "a"), "new");
}

TEST(PendingFiles, ALinkStaysALink) {
  const TemporaryFolder folder;
  write_text(folder / "real", "old");
  std::filesystem::create_symlink("real", folder / "link");
  PendingFiles files(folder / "a");
  ASSERT_TRUE(files.add(folder / "link", std::string_view("new")));
  ASSERT_TRUE(files.commit());
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(read_text(folder / "real"), "new");
}

TEST(PendingFiles, WhatIsNoFileIsNotReplaced) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "a");
  PendingFiles files(folder / "a");
  const Result<Done> added = files.add(folder / "a", std::string_view("one"));
  ASSERT_FALSE(added);
  EXPECT_EQ(added.error().code, ErrorCode::kCannotWrite);
  const Result<Done> device = files.add("/dev/full", std::string_view("one"));
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().place, "/dev/full");
}

TEST(PendingFiles, AFolderThatCannotBeMadeIsAnError) {
  const TemporaryFolder folder;
  write_text(folder / "file", "");
  PendingFiles files(folder / "a");
  const Result<Done> added = files.add(folder / "file/a", std::string_view("one"));
  ASSERT_FALSE(added);
  EXPECT_EQ(added.error().code, ErrorCode::kCannotWrite);
}

TEST(PendingFiles, AFailedRenameLeavesNoTemporaryFiles) {
  const TemporaryFolder folder;
  {
    PendingFiles files(folder / "a");
    ASSERT_TRUE(files.add(folder / "a", std::string_view("one")));
    std::filesystem::create_directories(folder / "a/in the way");
    const Result<Done> committed = files.commit();
    ASSERT_FALSE(committed);
    EXPECT_EQ(committed.error().code, ErrorCode::kCannotWrite);
  }
  EXPECT_THAT(names_in(folder.path()), ElementsAre("a"));
}

TEST(PendingFiles, WhatMustNotReplaceAnythingFails) {
  const TemporaryFolder folder;
  PendingFiles files(folder / "a");
  ASSERT_TRUE(files.add(folder / "a", bytes_in("ours"), Replace::kNo));
  write_text(folder / "a", "theirs, meanwhile");
  EXPECT_FALSE(files.commit());
  EXPECT_EQ(read_text(folder / "a"), "theirs, meanwhile");
}

// Temporary files of processes that were killed.

TEST(PendingFiles, WhatADeadProcessLeftIsRemovedByTheNext) {
  const TemporaryFolder folder;
  for (const char* name : {".a.tmp-1-0", ".a.tmp-99999-3", ".b.tmp-1-0", "a.tmp-1-0"}) write_text(folder / name, "x");
  PendingFiles files(folder / "a");
  ASSERT_TRUE(files.add(folder / "a", std::string_view("new")));
  ASSERT_TRUE(files.commit());
  EXPECT_THAT(names_in(folder.path()), ElementsAre(".b.tmp-1-0", "a", "a.tmp-1-0"));
}

TEST(PendingFiles, WhatALivingProcessWritesStays) {
  const TemporaryFolder folder;
  PendingFiles first(folder / "a"), second(folder / "a");
  ASSERT_TRUE(first.add(folder / "a", std::string_view("first")));
  ASSERT_TRUE(second.add(folder / "a", std::string_view("second")));
  ASSERT_TRUE(first.commit());
  EXPECT_EQ(read_text(folder / "a"), "first");
  ASSERT_TRUE(second.commit());
  EXPECT_EQ(read_text(folder / "a"), "second");
}

TEST(PendingFiles, AProcessThatEndsWithoutDestructorsCanStillTidyUp) {
  const TemporaryFolder folder;
  write_text(folder / ".a.tmp-1-0", "another process's");
  PendingFiles files(folder / "b");
  ASSERT_TRUE(files.add(folder / "b", std::string_view("b")));
  remove_own_temporaries(folder / "a");
  EXPECT_EQ(names_in(folder.path()).size(), 2U);
  remove_own_temporaries(folder / "b");
  EXPECT_THAT(names_in(folder.path()), ElementsAre(".a.tmp-1-0"));
}

}  // namespace
}  // namespace gltf_radiosity
