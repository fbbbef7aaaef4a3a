// `gltf-radiosity view`: what the user asked for. Nothing here prints or exits.
#pragma once

#include <span>
#include <string>
#include <variant>

#include "plugin/view.h"
#include "tools/command_line.h"

namespace gltf_radiosity::tools {

/// A baked file to look at.
struct ViewCommand {
  std::string baked;
  std::string html;  ///< the page
  ViewOptions options;
  ProgressStyle progress = ProgressStyle::kAuto;
};

/// Whether `arguments`, as main gets them, ask for this command: `view` is the first word.
bool is_view_command(std::span<const char* const> arguments);

/// REQUIRES: is_view_command(arguments).
std::variant<ViewCommand, Ending> parse_view_command(std::span<const char* const> arguments);

/// What `view --help` prints.
std::string view_help_text();

}  // namespace gltf_radiosity::tools
