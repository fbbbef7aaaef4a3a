#include "tools/view_command.h"

#include <CLI/CLI.hpp>
#include <array>
#include <memory>
#include <string_view>
#include <utility>

#include "tools/help_text.h"
#include "tools/shared_options.h"

namespace gltf_radiosity::tools {
namespace {

/// The parser and where its values go. Not movable: the parser's callbacks point into it.
struct ViewParser {
  ViewCommand command;
  CLI::App app{std::string(kViewDescription), "gltf-radiosity view"};

  ViewParser() {
    app.formatter(std::make_shared<HelpFormatter>("OUT --html FILE"));
    app.footer(std::string(kViewFooter));
    app.add_option("OUT", command.baked, "The baked scene: a .glb or .gltf file with its light in COLOR_0")->required();
    app.option_defaults()->group("Output");
    add(app, {"--html", "FILE", "needed", "The page; it needs neither a network nor any file beside it"},
        [this](const std::string& text) { command.html = text; })
        ->required();
    add(app, {"--title", "TEXT", "auto", "What stands on top of it; auto is the name of OUT"},
        [this](const std::string& text) { command.options.title = text == "auto" ? "" : text; });
    add_progress_option(app, command.progress);
    app.option_defaults()->group("Other");
    add_version_and_help(app);
  }
  ViewParser(const ViewParser&) = delete;
  ViewParser& operator=(const ViewParser&) = delete;
};

void finish_view(const ViewCommand& command) {
  if (command.baked.empty() || command.html.empty()) throw CLI::ValidationError("OUT and --html must not be empty");
  check_that_differs("--html", command.html, std::array{command.baked});
}

}  // namespace

bool is_view_command(std::span<const char* const> arguments) { return names_subcommand(arguments, "view"); }

std::variant<ViewCommand, Ending> parse_view_command(std::span<const char* const> arguments) {
  return parse_subcommand<ViewParser>(arguments, finish_view);
}

std::string view_help_text() { return ViewParser().app.help(); }

}  // namespace gltf_radiosity::tools
