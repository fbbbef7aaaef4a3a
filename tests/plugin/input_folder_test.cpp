#include "plugin/input_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

using testing::HasSubstr;

/// A folder with a file, beside a file that is none of its business.
struct Jail {
  TemporaryFolder root;
  InputFolder inside{root / "inside"};

  Jail() {
    std::filesystem::create_directories(root / "inside/below");
    write_text(root / "inside/below/mine", "mine");
    write_text(root / "secret", "secret");
  }

  /// What is read, or why not.
  std::string read(const std::string& uri) const {
    const auto bytes = read_file_of_uri(uri, inside, "buffers[0]");
    return bytes ? std::string(bytes->begin(), bytes->end()) : bytes.error().text();
  }
};

TEST(InputFolder, FilesInTheFolderAndBelowAreRead) {
  const Jail jail;
  EXPECT_EQ(jail.read("below/mine"), "mine");
  EXPECT_EQ(jail.read("./below//../below/%6Dine"), "mine");
}

TEST(InputFolder, LinksThatStayInsideAreFollowed) {
  const Jail jail;
  std::filesystem::create_symlink("mine", jail.root / "inside/below/relative");
  std::filesystem::create_symlink(jail.root / "inside/below", jail.root / "inside/absolute");
  EXPECT_EQ(jail.read("below/relative"), "mine");
  EXPECT_EQ(jail.read("absolute/relative"), "mine");
}

TEST(InputFolder, NoNameLeadsOut) {
  const Jail jail;
  std::filesystem::create_symlink("../secret", jail.root / "inside/link");
  std::filesystem::create_symlink("..", jail.root / "inside/up");
  for (const std::string& uri :
       {std::string("../secret"), std::string("%2e%2E/secret"), std::string("%2E%2e%2fsecret"),
        std::string("below/../../secret"), std::string("..\\secret"), std::string("below\\..\\..\\secret"),
        std::string("\\\\host\\secret"), std::string("//host/secret"), (jail.root / "secret").string(),
        std::string("%2Fetc/passwd"), std::string("link"), std::string("up/secret"), std::string("up/up/etc")}) {
    EXPECT_THAT(jail.read(uri), testing::AnyOf(HasSubstr("lies outside the glTF's folder"), HasSubstr("is missing")))
        << uri;
  }
}

TEST(InputFolder, NoSchemeIsFollowed) {
  const Jail jail;
  for (const char* uri : {"file:///etc/passwd", "FILE:mine", "http://localhost/mine", "https://localhost/mine",
                          "ftp://localhost/mine", "C:\\mine", "c:/mine"}) {
    EXPECT_THAT(jail.read(uri), HasSubstr("is not a file beside the glTF")) << uri;
  }
}

TEST(InputFolder, OnlyRegularFilesAreRead) {
  const Jail jail;
  ASSERT_EQ(::mkfifo((jail.root / "inside/pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/zero", jail.root / "inside/device");
  EXPECT_EQ(jail.read("below"), "buffers[0]: \"below\" is no file");
  EXPECT_EQ(jail.read("pipe"), "buffers[0]: \"pipe\" is no file");
  EXPECT_THAT(jail.read("device"), HasSubstr("lies outside"));
  InputFolder anywhere = jail.inside;
  anywhere.may_leave = true;
  EXPECT_EQ(read_file_of_uri("device", anywhere, "").error().text(), "\"device\" is no file");
}

TEST(InputFolder, ALargerFileThanAllowedIsALimit) {
  Jail jail;
  jail.inside.max_bytes = 4;
  EXPECT_EQ(jail.read("below/mine"), "mine");
  jail.inside.max_bytes = 3;
  const auto bytes = read_file_of_uri("below/mine", jail.inside, "buffers[0]");
  ASSERT_FALSE(bytes);
  EXPECT_EQ(bytes.error().code, ErrorCode::kLimit);
  EXPECT_EQ(read_file("/dev/zero", "", 1000).error().code, ErrorCode::kLimit) << "has no end";
}

}  // namespace
}  // namespace gltf_radiosity
