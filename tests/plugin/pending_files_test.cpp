#include "plugin/pending_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(PendingFiles, NothingAppearsBeforeTheEnd) {
  const TemporaryFolder folder;
  PendingFiles files;
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
    PendingFiles files;
    ASSERT_TRUE(files.add(folder / "deep/down/a", std::string_view("one")));
  }
  EXPECT_THAT(names_in(folder.path()), IsEmpty());
}

TEST(PendingFiles, FoldersAreMade) {
  const TemporaryFolder folder;
  PendingFiles files;
  ASSERT_TRUE(files.add(folder / "deep/down/a", std::string_view("one")));
  ASSERT_TRUE(files.commit());
  EXPECT_EQ(read_text(folder / "deep/down/a"), "one");
}

TEST(PendingFiles, AnOldFileIsReplaced) {
  const TemporaryFolder folder;
  write_text(folder / "a", "something longer than the new text");
  PendingFiles files;
  ASSERT_TRUE(files.add(folder / "a", std::string_view("new")));
  ASSERT_TRUE(files.commit());
  EXPECT_EQ(read_text(folder / "a"), "new");
}

TEST(PendingFiles, ALinkStaysALink) {
  const TemporaryFolder folder;
  write_text(folder / "real", "old");
  std::filesystem::create_symlink("real", folder / "link");
  PendingFiles files;
  ASSERT_TRUE(files.add(folder / "link", std::string_view("new")));
  ASSERT_TRUE(files.commit());
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(read_text(folder / "real"), "new");
}

TEST(PendingFiles, WhatIsNoFileIsNotReplaced) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "a");
  PendingFiles files;
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
  PendingFiles files;
  const Result<Done> added = files.add(folder / "file/a", std::string_view("one"));
  ASSERT_FALSE(added);
  EXPECT_EQ(added.error().code, ErrorCode::kCannotWrite);
}

TEST(PendingFiles, AFailedRenameLeavesNoTemporaryFiles) {
  const TemporaryFolder folder;
  {
    PendingFiles files;
    ASSERT_TRUE(files.add(folder / "a", std::string_view("one")));
    std::filesystem::create_directories(folder / "a/in the way");
    const Result<Done> committed = files.commit();
    ASSERT_FALSE(committed);
    EXPECT_EQ(committed.error().code, ErrorCode::kCannotWrite);
  }
  EXPECT_THAT(names_in(folder.path()), ElementsAre("a"));
}

}  // namespace
}  // namespace gltf_radiosity
