#include "tools/batch_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "tools/exit_code.h"

namespace gltf_radiosity::tools {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

/// An empty folder that goes away with the test.
class PlanBatch : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              (std::string("gltf_radiosity_plan_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void make(const std::string& file, const std::string& text = "") {
    fs::create_directories((folder_ / file).parent_path());
    std::ofstream(folder_ / file) << text;
  }
  /// Input and output of each file, from the top of the folder.
  std::vector<std::pair<std::string, std::string>> planned(const std::string& from, const std::string& to) {
    std::istringstream no_input;
    const auto plan = plan_batch(folder_ / from, folder_ / to, no_input);
    std::vector<std::pair<std::string, std::string>> files;
    if (const auto* refusal = std::get_if<Ending>(&plan)) return {{"refused", refusal->text}};
    for (const BatchFile& file : std::get<0>(plan)) {
      files.emplace_back(fs::path(file.input).lexically_relative(folder_),
                         fs::path(file.output).lexically_relative(folder_));
    }
    return files;
  }
  static std::vector<std::pair<std::string, std::string>> listed(const std::string& text) {
    std::istringstream input(text);
    const auto plan = plan_batch("-", "out", input);
    std::vector<std::pair<std::string, std::string>> files;
    if (const auto* refusal = std::get_if<Ending>(&plan)) return {{"refused", refusal->text}};
    for (const BatchFile& file : std::get<0>(plan)) files.emplace_back(file.input, file.output);
    return files;
  }

  fs::path folder_;
};

TEST_F(PlanBatch, TakesEveryGltfBelowAFolderInTheOrderOfItsPath) {
  for (const char* file : {"in/b.glb", "in/a/z.GLTF", "in/a.txt", "in/a/deep/er/c.glb", "in/glb"}) make(file);
  EXPECT_THAT(planned("in", "out"), ElementsAre(Pair("in/a/deep/er/c.glb", "out/a/deep/er/c.glb"),
                                                Pair("in/a/z.GLTF", "out/a/z.GLTF"), Pair("in/b.glb", "out/b.glb")));
}

TEST_F(PlanBatch, LeavesOutWhatLiesInTheOutputFolder) {
  for (const char* file : {"in/a.glb", "in/out/a.glb", "in/out/deep/a.glb"}) make(file);
  EXPECT_THAT(planned("in", "in/out"), ElementsAre(Pair("in/a.glb", "in/out/a.glb")));
  EXPECT_THAT(planned("in", "in/x/../out"), ElementsAre(Pair("in/a.glb", testing::_)));
}

TEST_F(PlanBatch, FollowsLinksToFilesButNotToFolders) {
  make("in/a.glb");
  make("elsewhere/b.glb");
  fs::create_symlink("../elsewhere/b.glb", folder_ / "in/link.glb");
  fs::create_directory_symlink("..", folder_ / "in/up");
  EXPECT_THAT(planned("in", "out"), ElementsAre(Pair("in/a.glb", testing::_), Pair("in/link.glb", "out/link.glb")));
}

TEST_F(PlanBatch, AFolderWithoutScenesIsRefused) {
  make("in/readme.txt");
  EXPECT_THAT(planned("in", "out"), ElementsAre(Pair("refused", HasSubstr("holds no .glb and no .gltf"))));
}

TEST_F(PlanBatch, TheOutputFolderMustBeAnother) {
  make("in/a.glb");
  EXPECT_THAT(planned("in", "in/../in"), ElementsAre(Pair("refused", HasSubstr("would replace those of IN_DIR"))));
}

TEST_F(PlanBatch, AListKeepsRelativeFoldersAndOnlyTheNamesOfOthers) {
  EXPECT_THAT(listed("x/a.glb\n\n./y/../b.gltf\r\n../c.glb\n/far/away/d.glb"),
              ElementsAre(Pair("x/a.glb", "out/x/a.glb"), Pair("./y/../b.gltf", "out/b.gltf"),
                          Pair("../c.glb", "out/c.glb"), Pair("/far/away/d.glb", "out/d.glb")));
}

TEST_F(PlanBatch, ANameIsTakenAsItIs) {
  EXPECT_THAT(listed(" spaces .glb \n#hash.glb\n-dash.glb"),
              ElementsAre(Pair(" spaces .glb ", "out/ spaces .glb "), Pair("#hash.glb", "out/#hash.glb"),
                          Pair("-dash.glb", "out/-dash.glb")));
}

TEST_F(PlanBatch, TwoInputsWithOneOutputAreRefused) {
  EXPECT_THAT(listed("/x/a.glb\n/y/a.glb"),
              ElementsAre(Pair("refused", HasSubstr("/x/a.glb and /y/a.glb would both become out/a.glb"))));
  EXPECT_THAT(listed("a.glb\n./a.glb"), ElementsAre(Pair("refused", HasSubstr("would both become"))));
  EXPECT_THAT(listed("a.glb\na.gltf"), ElementsAre(testing::_, testing::_)) << "endings stay, so these differ";
}

TEST_F(PlanBatch, AnOutputThatIsAnInputIsRefused) {
  EXPECT_THAT(listed("x/a.glb\nout/x/a.glb"), ElementsAre(Pair("refused", HasSubstr("it is an input"))));
}

TEST_F(PlanBatch, AListThatNamesNothingOrIsAScenePerMistakeIsRefused) {
  EXPECT_THAT(listed("\n\n"), ElementsAre(Pair("refused", "standard input: names no file")));
  make("scene.glb", "glTF");
  EXPECT_THAT(planned("scene.glb", "out"), ElementsAre(Pair("refused", HasSubstr("is no folder and no list"))));
  EXPECT_THAT(planned("missing", "out"), ElementsAre(Pair("refused", HasSubstr("missing: cannot be read"))));
}

}  // namespace
}  // namespace gltf_radiosity::tools
