// `gltf-radiosity verify`: what the user asked for. Nothing here prints or exits.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <variant>

#include "plugin/verify.h"
#include "tools/command_line.h"

namespace gltf_radiosity::tools {

/// A bake to be verified.
struct VerifyCommand {
  std::string input;
  std::string output;
  VerifyOptions options;
  std::optional<double> max_error;  ///< relative RMSE that is still good enough
  ProgressStyle progress = ProgressStyle::kAuto;
  std::string json;  ///< file for the report, "-" for stdout, empty for none
};

/// Whether `arguments`, as main gets them, ask for this command: `verify` is the first word.
bool is_verify_command(std::span<const char* const> arguments);

/// REQUIRES: is_verify_command(arguments).
std::variant<VerifyCommand, Ending> parse_verify_command(std::span<const char* const> arguments);

/// What `verify --help` prints.
std::string verify_help_text();

}  // namespace gltf_radiosity::tools
