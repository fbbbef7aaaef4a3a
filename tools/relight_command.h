// `gltf-radiosity relight`: what the user asked for. Nothing here prints or exits.
#pragma once

#include <span>
#include <string>
#include <variant>

#include "plugin/relight.h"
#include "tools/command_line.h"

namespace gltf_radiosity::tools {

/// A bake to be lit otherwise.
struct RelightCommand {
  std::string transport;
  std::string output;
  RelightOptions options;
  std::string json;  ///< file for the report, "-" for stdout, empty for none
};

/// Whether `arguments`, as main gets them, ask for this command: `relight` is the first word.
bool is_relight_command(std::span<const char* const> arguments);

/// REQUIRES: is_relight_command(arguments).
std::variant<RelightCommand, Ending> parse_relight_command(std::span<const char* const> arguments);

/// What `relight --help` prints.
std::string relight_help_text();

}  // namespace gltf_radiosity::tools
