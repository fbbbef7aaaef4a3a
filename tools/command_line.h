// What the user asked for, read from the command line and a configuration file. Nothing here prints or exits.
#pragma once

#include <span>
#include <string>
#include <variant>

#include "plugin/gltf_radiosity.h"

namespace gltf_radiosity::tools {

/// How progress is shown on stderr. kAuto: a bar if stderr is a terminal, plain lines otherwise.
enum class ProgressStyle { kAuto, kBar, kPlain, kNone };

/// A bake to be done, or with `batch` many.
struct CommandLine {
  std::string input;   ///< with `batch` a folder or a list: batch_plan.h
  std::string output;  ///< with `batch` a folder
  bool batch = false;
  int jobs = 0;  ///< files that a batch bakes at once; 0 chooses
  Options options;
  ProgressStyle progress = ProgressStyle::kAuto;
  std::string json;  ///< file for the report, "-" for stdout, empty for none
};

/// Nothing is to be baked: --help, --version, or a mistake.
struct Ending {
  int exit_code = 0;
  std::string text;  ///< for stdout if `exit_code` is 0, else one line for stderr without the program's name
};

/// `arguments` as main gets them, the program's name first. Reads the file that --config names.
std::variant<CommandLine, Ending> parse_command_line(std::span<const char* const> arguments);

/// What --help prints.
std::string help_text();

}  // namespace gltf_radiosity::tools
