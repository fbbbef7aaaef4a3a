#include "tools/report_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tools/exit_code.h"

namespace gltf_radiosity::tools {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// An empty folder that goes away with the test.
class WriteReport : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              (std::string("gltf_radiosity_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::ptrdiff_t file_count() const { return std::distance(fs::directory_iterator(folder_), fs::directory_iterator()); }

  fs::path folder_;
};

TEST_F(WriteReport, LeavesOneFileThatEndsWithALineBreak) {
  EXPECT_EQ(write_report(folder_ / "r.json", "{}"), std::nullopt);
  EXPECT_EQ(content(folder_ / "r.json"), "{}\n");
  EXPECT_EQ(file_count(), 1);
}

TEST_F(WriteReport, ReplacesAnOldReport) {
  std::ofstream(folder_ / "r.json") << "something longer than the new one";
  EXPECT_EQ(write_report(folder_ / "r.json", "{}"), std::nullopt);
  EXPECT_EQ(content(folder_ / "r.json"), "{}\n");
}

TEST_F(WriteReport, WritesThroughALink) {
  std::ofstream(folder_ / "real.json") << "old";
  fs::create_symlink("real.json", folder_ / "link.json");
  EXPECT_EQ(write_report(folder_ / "link.json", "{}"), std::nullopt);
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.json"));
  EXPECT_EQ(content(folder_ / "real.json"), "{}\n");
}

TEST_F(WriteReport, SaysWhyItFailedAndLeavesNothingBehind) {
  const std::string path = folder_ / "no" / "such" / "r.json";
  EXPECT_THAT(write_report(path, "{}").value_or("written"), testing::StartsWith(path + ": "));
  EXPECT_TRUE(write_report(folder_, "{}").has_value()) << "a folder is no file";
  EXPECT_EQ(file_count(), 0);
}

TEST_F(WriteReport, NoticesAFullDeviceAndDoesNotReplaceIt) {
  if (!fs::is_character_file("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  EXPECT_TRUE(write_report("/dev/full", "{}").has_value());
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  EXPECT_EQ(write_report("/dev/null", "{}"), std::nullopt);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(ErrorReport, NamesCodePlaceAndMessage) {
  EXPECT_EQ(to_json(Error{ErrorCode::kBadInput, "meshes[3]", "no POSITION"}),
            "{\n  \"error\": {\n    \"code\": \"bad-input\",\n    \"place\": \"meshes[3]\",\n"
            "    \"message\": \"no POSITION\"\n  }\n}");
}

TEST(ErrorReport, EscapesWhatJsonDoesNotAllow) {
  const auto message = [](const std::string& text) {
    const std::string json = to_json(Error{ErrorCode::kLimit, "", text});
    const std::size_t begin = json.find("\"message\": ") + 11;
    return json.substr(begin, json.find("\n", begin) - begin);
  };
  EXPECT_EQ(message("a\"b\\c"), R"("a\"b\\c")");
  EXPECT_EQ(message("a\nb\x01"), R"("a\u000ab\u0001")");
  EXPECT_EQ(message("Küche 台所 🏠"), "\"Küche 台所 🏠\"");
}

TEST(ErrorReport, ReplacesBytesThatAreNoUtf8) {
  const auto place = [](const std::string& text) {
    const std::string json = to_json(Error{ErrorCode::kLimit, text, ""});
    const std::size_t begin = json.find("\"place\": ") + 9;
    return json.substr(begin, json.find(",\n", begin) - begin);
  };
  EXPECT_EQ(place("a\xff"), R"("a\ufffd")") << "no UTF-8 at all";
  EXPECT_EQ(place("\xc3"), R"("\ufffd")") << "cut short";
  EXPECT_EQ(place("\xc0\xaf"), R"("\ufffd\ufffd")") << "overlong";
  EXPECT_EQ(place("\xed\xa0\x80"), R"("\ufffd\ufffd\ufffd")") << "a surrogate";
  EXPECT_EQ(place("\xf4\x90\x80\x80"), R"("\ufffd\ufffd\ufffd\ufffd")") << "beyond U+10FFFF";
}

TEST(ExitCode, IsWhatTheDocumentationPromises) {
  EXPECT_EQ(exit_code_of(ErrorCode::kBadInput, 0), 1);
  EXPECT_EQ(exit_code_of(ErrorCode::kBadOption, 0), 2);
  EXPECT_EQ(exit_code_of(ErrorCode::kCannotWrite, 0), 3);
  EXPECT_EQ(exit_code_of(ErrorCode::kLimit, 0), 4);
  EXPECT_EQ(exit_code_of(ErrorCode::kInternal, 0), 70);
  EXPECT_EQ(exit_code_of(ErrorCode::kCancelled, 2), 130);
  EXPECT_EQ(exit_code_of(ErrorCode::kCancelled, 15), 143);
}

}  // namespace
}  // namespace gltf_radiosity::tools
