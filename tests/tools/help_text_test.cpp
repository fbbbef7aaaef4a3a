#include "tools/help_text.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "tools/command_line.h"
#include "tools/relight_command.h"
#include "tools/verify_command.h"
#include "tools/view_command.h"

namespace gltf_radiosity::tools {
namespace {

std::set<std::string> matches(const std::string& text, const std::string& pattern) {
  std::set<std::string> found;
  const std::regex expression(pattern);
  for (auto match = std::sregex_iterator(text.begin(), text.end(), expression); match != std::sregex_iterator();
       ++match) {
    found.insert((*match)[1].str());
  }
  return found;
}

/// "--patch-size METRES|auto" for each option that --help describes.
std::set<std::string> described_options(const std::string& help) {
  return matches(help, "\n  (?:-h,)?(--[a-z0-9-]+(?: [^ \n]+)?) *(?:  |\n)");
}

/// What `help` says about `option`, on one line.
std::string description_of(const std::string& option, const std::string& help = help_text()) {
  const std::size_t begin = help.find("\n  " + option + " ");
  if (begin == std::string::npos) return "no such option";
  std::size_t end = help.find('\n', begin + 1);
  while (end != std::string::npos && help.compare(end, 11, "\n          ") == 0) end = help.find('\n', end + 1);
  return std::regex_replace(help.substr(begin, end - begin), std::regex("\\s+"), " ");
}

std::string documentation(const std::string& page) {
  std::ifstream file(PROJECT_SOURCE_DIR "/docs/" + page);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The commands, each with the page that documents it.
struct Command {
  std::string help;
  std::string page;
  std::size_t example_count;  ///< at least
};
std::vector<Command> commands() {
  return {{help_text(), "command-line.md", 3},
          {verify_help_text(), "verify.md", 3},
          {view_help_text(), "view.md", 2},
          {relight_help_text(), "relight.md", 3}};
}

bool is_accepted(const std::vector<const char*>& arguments) {
  if (is_verify_command(arguments)) return std::holds_alternative<VerifyCommand>(parse_verify_command(arguments));
  if (is_view_command(arguments)) return std::holds_alternative<ViewCommand>(parse_view_command(arguments));
  if (is_relight_command(arguments)) return std::holds_alternative<RelightCommand>(parse_relight_command(arguments));
  return std::holds_alternative<CommandLine>(parse_command_line(arguments));
}

TEST(HelpText, DescribesEveryOption) {
  const std::set<std::string> names = matches(help_text(), "\n  (?:-h,)?(--[a-z0-9-]+)");
  const std::set<std::string> expected = {"--scene",
                                          "--refine",
                                          "--patch-size",
                                          "--subdivide",
                                          "--sky",
                                          "--sun",
                                          "--no-default-sky",
                                          "--metals",
                                          "--quality",
                                          "--hemicube",
                                          "--max-patches",
                                          "--residual",
                                          "--visibility",
                                          "--solver",
                                          "--fit",
                                          "--max-memory",
                                          "--threads",
                                          "--exposure",
                                          "--ev100",
                                          "--color-type",
                                          "--cache",
                                          "--cache-size",
                                          "--batch",
                                          "--jobs",
                                          "--json",
                                          "--progress",
                                          "--light-units",
                                          "--allow-outside",
                                          "--force",
                                          "--time-limit",
                                          "--config",
                                          "--version",
                                          "--help",
                                          "--sky-rotation",
                                          "--max-error",
                                          "--max-vertices",
                                          "--simplify",
                                          "--error-space",
                                          "--draco",
                                          "--meshopt",
                                          "--select",
                                          "--exclude",
                                          "--bake",
                                          "--engine",
                                          "--target",
                                          "--two-sided",
                                          "--strip-lights",
                                          "--light-groups",
                                          "--group",
                                          "--scale-to-factor",
                                          "--no-scale-to-factor",
                                          "--radiance-attribute",
                                          "--save-transport"};
  EXPECT_EQ(names, expected);
}

TEST(HelpText, StatesTheDefaultsOfTheLibrary) {
  const Options library;
  const std::vector<std::pair<std::string, std::string>> expected = {
      {"--cache", "none"},
      {"--cache-size", fmt::format("{}G", library.cache_size >> 30U)},
      {"--batch", "off"},
      {"--jobs", "auto"},
      {"--scene", "auto"},
      {"--refine", "adaptive"},
      {"--max-error", fmt::format("{}", library.max_error)},
      {"--max-vertices", "auto"},
      {"--error-space", "display"},
      {"--patch-size", "auto"},
      {"--subdivide", "none"},
      {"--simplify", "off"},
      {"--sky", "none"},
      {"--sky-rotation", fmt::format("{}", library.sky_rotation_degrees)},
      {"--sun", "none"},
      {"--no-default-sky", "off"},
      {"--metals", "diffuse"},
      {"--light-units", "auto"},
      {"--quality", "medium"},
      {"--hemicube", fmt::format("{}", library.hemicube)},
      {"--max-patches", "auto"},
      {"--residual", fmt::format("{}", library.residual)},
      {"--visibility", "auto"},
      {"--solver", "gathering"},
      {"--fit", "least-squares"},
      {"--max-memory", "75 %"},
      {"--threads", "0"},
      {"--exposure", "auto"},
      {"--ev100", "none"},
      {"--color-type", "float"},
      {"--json", "none"},
      {"--progress", "auto"},
      {"--config", "none"},
      {"--draco", "off"},
      {"--meshopt", "off"},
      {"--select", "none"},
      {"--exclude", "none"},
      {"--bake", "both"},
      {"--engine", "any"},
      {"--target", "unlit"},
      {"--two-sided", "front"},
      {"--strip-lights", "off"},
      {"--light-groups", "none"},
      {"--group", "none"},
      {"--scale-to-factor", "off"},
      {"--no-scale-to-factor", "off"},
      {"--radiance-attribute", "none"},
      {"--save-transport", "none"},
  };
  for (const auto& [option, preset] : expected) {
    const std::string description = description_of(option);
    EXPECT_NE(description.find("(default: " + preset + ")"), std::string::npos) << description;
  }
}

TEST(HelpText, FitsAHundredColumns) {
  for (const Command& command : commands()) {
    std::istringstream lines(command.help);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
  }
}

TEST(HelpText, ItsExamplesAreAccepted) {
  for (const Command& command : commands()) {
    const std::set<std::string> examples = matches(command.help, "\n  gltf-radiosity ([^\n]+)");
    EXPECT_GE(examples.size(), command.example_count);
    for (const std::string& example : examples) {
      std::vector<std::string> words = {"gltf-radiosity"};
      std::istringstream stream(example);
      for (std::string word; stream >> word;) words.push_back(word);
      std::vector<const char*> arguments;
      for (const std::string& word : words) arguments.push_back(word.c_str());
      EXPECT_TRUE(is_accepted(arguments)) << example;
    }
  }
}

TEST(HelpText, AgreesWithTheDocumentation) {
  for (const Command& command : commands()) {
    const std::set<std::string> documented = matches(documentation(command.page), "\n\\| `((?:--)[^`]+)` \\|");
    std::set<std::string> unescaped;
    for (const std::string& option : documented)
      unescaped.insert(std::regex_replace(option, std::regex("\\\\\\|"), "|"));
    EXPECT_EQ(unescaped, described_options(command.help)) << command.page;
  }
}

TEST(HelpText, AgreesWithTheDocumentedDefaults) {
  // | `--hemicube CELLS` | 32 | ...
  const std::regex row("\n\\| `(--[a-z0-9-]+)[^`]*` \\| ([^|]+) \\|");
  for (const Command& command : commands()) {
    const std::string text = documentation(command.page);
    std::size_t rows = 0;
    for (auto match = std::sregex_iterator(text.begin(), text.end(), row); match != std::sregex_iterator();
         ++match, ++rows) {
      const std::string option = (*match)[1].str();
      const std::string preset = (*match)[2].str();
      if (option == "--help" || option == "--version") continue;
      const std::string description = description_of(option, command.help);
      EXPECT_NE(description.find("(default: " + preset + ")"), std::string::npos)
          << preset << " is not in " << description;
    }
    EXPECT_EQ(rows, described_options(command.help).size()) << command.page;
  }
}

}  // namespace
}  // namespace gltf_radiosity::tools
