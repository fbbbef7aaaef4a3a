#include "tools/verify_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <limits>
#include <memory>
#include <string_view>
#include <tuple>
#include <utility>

#include "tools/help_text.h"
#include "tools/option_values.h"
#include "tools/shared_options.h"

namespace gltf_radiosity::tools {
namespace {

constexpr double kFar = 1e30;

void add_files(CLI::App& app, VerifyCommand& command) {
  app.add_option("IN", command.input, "The scene that was baked: a .glb or .gltf file")->required();
  app.add_option("OUT", command.output, "The baked scene, by gltf-radiosity or another baker")->required();
}

void add_sampling_options(CLI::App& app, VerifyCommand& command) {
  VerifyOptions& options = command.options;
  app.option_defaults()->group("Sampling: how exactly the error is known");
  add(app, {"--points", "COUNT", std::to_string(options.points), "Random places on the baked surfaces, up to 10000000"},
      [&options](const std::string& text) { options.points = parse_integer(text, 1, 10'000'000); });
  add(app,
      {"--noise", "SHARE", fmt::format("{}", options.noise),
       "Noise of the truth, over mean luminance, that is low enough; above 0. What is left is taken out of the error"},
      [&options](const std::string& text) { options.noise = parse_number(text, {.open = true}); });
  add(app,
      {"--max-samples", "COUNT", std::to_string(options.max_samples),
       "Paths that may be spent on each place to get there, 64 to 1048576"},
      [&options](const std::string& text) { options.max_samples = parse_integer(text, 64, 1 << 20); });
  add(app, {"--seed", "NUMBER", std::to_string(options.seed), "Another number takes other places and other paths"},
      [&options](const std::string& text) {
        options.seed = static_cast<std::uint64_t>(parse_integer(text, 0, std::numeric_limits<int>::max()));
      });
  add_threads_option(app, options.bake);
}

void add_place(CLI::App& app, const OptionText& text, std::optional<std::array<double, 3>>& place) {
  constexpr Range kAnywhere{-kFar, kFar};
  add(app, text, [&place, kAnywhere](const std::string& value) {
    place = parse_triple(value, {kAnywhere, kAnywhere, kAnywhere});
  });
}

void add_picture_options(CLI::App& app, VerifyOptions& options) {
  app.option_defaults()->group("Picture");
  VerifyCamera& camera = options.camera;
  add(app,
      {"--image", "FILE.png", "none",
       "Draw the baked file, the truth, and the error beside each other: blue is too dark, red too bright"},
      [&options](const std::string& text) { options.image = text; });
  add_place(
      app,
      {"--eye", "X,Y,Z", "auto", "Where the camera is, metres; auto is outside, on the diagonal of the bounding box"},
      camera.eye);
  add_place(app, {"--at", "X,Y,Z", "auto", "What it looks at, metres; auto is the middle of the bounding box"},
            camera.at);
  add(app,
      {"--fov", "DEGREES", fmt::format("{}", camera.fov_degrees), "Its field of view from top to bottom, below 180"},
      [&camera](const std::string& text) {
        camera.fov_degrees = parse_number(text, {0.0, 180.0, true});
      });
  add(app,
      {"--size", "W,H", fmt::format("{},{}", camera.width, camera.height),
       "Pixels of each of the three panels, 16 to 8192"},
      [&camera](const std::string& text) { std::tie(camera.width, camera.height) = parse_size(text, 16, 8192); });
  add(app,
      {"--image-samples", "COUNT", std::to_string(options.image_samples),
       "Paths for each pixel of the truth, up to 1048576"},
      [&options](const std::string& text) { options.image_samples = parse_integer(text, 1, 1 << 20); });
}

void add_output_options(CLI::App& app, VerifyCommand& command) {
  app.option_defaults()->group("Output");
  add(app,
      {"--max-error", "SHARE", "none",
       "End with exit code 5 if the relative RMSE is above this: 0.02 is 2 %; not negative"},
      [&command](const std::string& text) { command.max_error = parse_number(text, {}); });
  add_json_option(app, command.json);
  add_progress_option(app, command.progress);
}

/// The parser and where its values go. Not movable: the parser's callbacks point into it.
struct VerifyParser {
  VerifyCommand command;
  CLI::App app{std::string(kVerifyDescription), "gltf-radiosity verify"};

  VerifyParser() {
    app.formatter(std::make_shared<HelpFormatter>());
    app.footer(std::string(kVerifyFooter));
    add_files(app, command);
    add_input_options(app, command.options.bake);
    add_sampling_options(app, command);
    add_light_options(app, command.options.bake);
    add_picture_options(app, command.options);
    add_output_options(app, command);
    app.option_defaults()->group("Other");
    add_version_and_help(app);
  }
  VerifyParser(const VerifyParser&) = delete;
  VerifyParser& operator=(const VerifyParser&) = delete;
};

void finish_verify(VerifyCommand& command) {
  if (command.input.empty() || command.output.empty()) throw CLI::ValidationError("IN and OUT must not be empty");
  if (command.json == "-") return;
  check_that_differs("--json", command.json, std::array{command.input, command.output});
  command.options.bake.also_written.push_back(command.json);
}

}  // namespace

bool is_verify_command(std::span<const char* const> arguments) { return names_subcommand(arguments, "verify"); }

std::variant<VerifyCommand, Ending> parse_verify_command(std::span<const char* const> arguments) {
  return parse_subcommand<VerifyParser>(arguments, finish_verify);
}

std::string verify_help_text() { return VerifyParser().app.help(); }

}  // namespace gltf_radiosity::tools
