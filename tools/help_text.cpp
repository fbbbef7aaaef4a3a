#include "tools/help_text.h"

#include <sstream>
#include <utility>

namespace gltf_radiosity::tools {
namespace {

constexpr std::size_t kLeftColumn = 36;
constexpr std::size_t kRightColumn = 64;

/// Breaks `text` at spaces so that no line is longer than `width`; line breaks stay.
std::string wrap(const std::string& text, std::size_t width) {
  std::string wrapped;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!wrapped.empty()) wrapped += '\n';
    std::size_t used = 0;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      const bool fits = used == 0 || used + 1 + word.size() <= width;
      wrapped += used == 0 ? "" : fits ? " " : "\n";
      used = fits && used != 0 ? used + 1 + word.size() : word.size();
      wrapped += word;
    }
  }
  return wrapped;
}

}  // namespace

HelpFormatter::HelpFormatter(std::string usage) : usage_(std::move(usage)) { column_width(kLeftColumn); }

std::string HelpFormatter::make_usage(const CLI::App* /*app*/, std::string name) const {
  return "\nUsage: " + name + " " + usage_ + " [options]\n";
}

std::string HelpFormatter::make_group(std::string title, bool is_positional,
                                      std::vector<const CLI::Option*> options) const {
  // CLI11 puts an empty line between the groups of options, and none around the positionals
  std::string group = is_positional ? "\nFiles:\n" : title + ":\n";
  for (const CLI::Option* const option : options) group += make_option(option, is_positional);
  return is_positional ? group + "\n" : group;
}

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  const bool takes_value = option->get_type_size() != 0 && !option->get_positional();
  return takes_value ? " " + option->get_type_name() : "";
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  const std::string preset = option->get_default_str();
  return wrap(option->get_description() + (preset.empty() ? "" : " (default: " + preset + ")"), kRightColumn);
}

}  // namespace gltf_radiosity::tools
