#include "tools/view_command.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gltf_radiosity::tools {
namespace {

using Words = std::vector<std::string>;

std::variant<ViewCommand, Ending> parse_view(const Words& more) {
  std::vector<const char*> pointers = {"gltf-radiosity", "view"};
  for (const std::string& word : more) pointers.push_back(word.c_str());
  EXPECT_TRUE(is_view_command(pointers));
  return parse_view_command(pointers);
}

std::string view_mistake(const Words& words) {
  const auto parsed = parse_view(words);
  const auto* const ending = std::get_if<Ending>(&parsed);
  return ending == nullptr || ending->exit_code != 2 ? "accepted" : ending->text;
}

TEST(ViewCommand, IsTheFirstWordAndNoOther) {
  const char* const bake[] = {"gltf-radiosity", "./view", "out.glb"};
  const char* const last[] = {"gltf-radiosity", "in.glb", "view"};
  const char* const none[] = {"gltf-radiosity"};
  EXPECT_FALSE(is_view_command(bake));
  EXPECT_FALSE(is_view_command(last));
  EXPECT_FALSE(is_view_command(none));
}

TEST(ViewCommand, TakesEveryOption) {
  const auto parsed = parse_view({"out.glb", "--html", "page.html", "--title", "A hall", "--progress", "none"});
  ASSERT_TRUE(std::holds_alternative<ViewCommand>(parsed));
  const auto& command = std::get<ViewCommand>(parsed);
  EXPECT_EQ(command.baked, "out.glb");
  EXPECT_EQ(command.html, "page.html");
  EXPECT_EQ(command.options.title, "A hall");
  EXPECT_EQ(command.progress, ProgressStyle::kNone);
}

TEST(ViewCommand, RefusesWhatMakesNoSense) {
  EXPECT_NE(view_mistake({}), "accepted");
  EXPECT_NE(view_mistake({"out.glb"}).find("--html"), std::string::npos);
  EXPECT_NE(view_mistake({"out.glb", "--html", ""}), "accepted");
  EXPECT_NE(view_mistake({"out.glb", "--html", "out.glb"}).find("--html"), std::string::npos);
  EXPECT_NE(view_mistake({"out.glb", "--html", "page.html", "--hemicube", "16"}).find("--hemicube"), std::string::npos);
}

TEST(ViewCommand, HelpAndVersionEndWell) {
  for (const char* option : {"--help", "-h", "--version"}) {
    const auto parsed = parse_view({option});
    ASSERT_TRUE(std::holds_alternative<Ending>(parsed));
    EXPECT_EQ(std::get<Ending>(parsed).exit_code, 0);
  }
}

}  // namespace
}  // namespace gltf_radiosity::tools
