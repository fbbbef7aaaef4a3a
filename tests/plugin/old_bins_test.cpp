#include "plugin/old_bins.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plugin/content_name.h"
#include "plugin/pending_files.h"
#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Not;

/// A .bin of what earlier runs wrote for out.gltf, under the name they gave it.
std::string write_bin(const TemporaryFolder& folder, const std::string& content) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(content.data());
  const std::string name = name_by_content("out.bin", {bytes, content.size()});
  write_text(folder / name, content);
  return name;
}

TEST(OldBins, WhatTheOutputNoLongerMentionsIsRemoved) {
  const TemporaryFolder folder;
  const std::string used = write_bin(folder, "new"), unused = write_bin(folder, "old");
  write_text(folder / "out.gltf", used);
  remove_old_bins(folder / "out.gltf");
  EXPECT_THAT(names_in(folder.path()), ElementsAre(used, "out.gltf"));
}

TEST(OldBins, WhatACopyOfTheOldOutputMentionsStays) {
  for (const char* copy : {"other.gltf", "out.GLTF", "out.gltf.bak"}) {
    const TemporaryFolder folder;
    const std::string used = write_bin(folder, "old");
    write_text(folder / "out.gltf", "");
    write_text(folder / copy, used);
    remove_old_bins(folder / "out.gltf");
    EXPECT_THAT(names_in(folder.path()), Contains(used)) << copy;
  }
}

TEST(OldBins, WhatWeDidNotWriteStays) {
  const TemporaryFolder folder;
  const std::string changed = write_bin(folder, "ours");
  write_text(folder / changed, "changed by somebody");
  for (const char* name : {"out.bin", "out-1.bin", "other-0123456789abcdef.bin", "out-0123456789abcdeg.bin"}) {
    write_text(folder / name, "theirs");
  }
  write_text(folder / "out.gltf", "");
  remove_old_bins(folder / "out.gltf");
  EXPECT_EQ(names_in(folder.path()).size(), 6U);
  EXPECT_THAT(names_in(folder.path()), Contains(changed));
}

TEST(OldBins, NothingIsRemovedWhileSomebodySwitches) {
  const TemporaryFolder folder;
  const std::string unused = write_bin(folder, "old");
  {
    const FolderLock somebody(folder.path(), FolderLock::Kind::kShared);
    ASSERT_TRUE(somebody.is_held());
    remove_old_bins(folder / "out.gltf");
    EXPECT_THAT(names_in(folder.path()), Contains(unused));
  }
  remove_old_bins(folder / "out.gltf");
  EXPECT_THAT(names_in(folder.path()), Not(Contains(unused)));
}

}  // namespace
}  // namespace gltf_radiosity
