#include "tools/relight_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/help_text.h"
#include "tools/option_values.h"
#include "tools/shared_options.h"

namespace gltf_radiosity::tools {
namespace {

constexpr std::string_view kRelightDescription =
    "Writes the glTF of a bake again, under other lights or with other reflectances: OUT shows what a\n"
    "bake of the changed scene would, in a moment. FILE.rad is what that bake wrote (--save-transport).";

constexpr std::string_view kRelightFooter =
    "Examples:\n"
    "  gltf-radiosity room.glb baked.glb --save-transport room.rad\n"
    "  gltf-radiosity relight room.rad evening.glb --light Window=1,0.6,0.3,40 --emissive Lamp=2.5\n"
    "      A dim, warm light at the window, and the lamp two and a half times as bright\n"
    "  gltf-radiosity relight room.rad blue.glb --reflectance Wall=0.2,0.3,0.7\n"
    "      The wall painted blue\n"
    "\n"
    "Exit codes: 0 done; 1 bad input; 2 wrong usage, or no such name; 3 cannot write; 4 limit reached;\n"
    "70 a bug of ours; 130 and 143 interrupted. The output appears whole or not at all.";

/// NAME=NUMBERS, cut at the last equals sign because names may hold one.
struct NamedNumbers {
  std::string name;
  std::vector<double> numbers;
};

NamedNumbers parse_named(std::string_view text, std::span<const std::size_t> counts) {
  const std::size_t cut = text.rfind('=');
  if (cut == std::string_view::npos || cut == 0) throw BadValue("'" + std::string(text) + "' is not NAME=VALUE");
  NamedNumbers named{std::string(text.substr(0, cut)), {}};
  std::string_view rest = text.substr(cut + 1);
  while (true) {
    const std::size_t comma = rest.find(',');
    named.numbers.push_back(parse_number(rest.substr(0, comma), {}));
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  if (std::ranges::count(counts, named.numbers.size()) > 0) return named;
  throw BadValue("'" + std::string(text) + "' has " + std::to_string(named.numbers.size()) + " numbers");
}

std::array<double, 3> first_three(const std::vector<double>& numbers) { return {numbers[0], numbers[1], numbers[2]}; }

std::pair<std::string, LightChange> parse_light(std::string_view text) {
  constexpr std::array<std::size_t, 3> kCounts{1, 3, 4};
  const NamedNumbers named = parse_named(text, kCounts);
  LightChange change;
  if (named.numbers.size() >= 3) change.color = first_three(named.numbers);
  if (named.numbers.size() != 3) change.intensity = named.numbers.back();
  return {named.name, change};
}

std::pair<std::string, EmissiveChange> parse_emissive(std::string_view text) {
  constexpr std::array<std::size_t, 2> kCounts{1, 3};
  const NamedNumbers named = parse_named(text, kCounts);
  EmissiveChange change;
  if (named.numbers.size() == 3) change.luminance = first_three(named.numbers);
  if (named.numbers.size() == 1) change.scale = named.numbers.front();
  return {named.name, change};
}

std::pair<std::string, std::array<double, 3>> parse_reflectance(std::string_view text) {
  constexpr std::array<std::size_t, 1> kCounts{3};
  const NamedNumbers named = parse_named(text, kCounts);
  for (const double band : named.numbers) {
    if (band > 1.0) throw BadValue("'" + std::string(text) + "' reflects more than 1");
  }
  return {named.name, first_three(named.numbers)};
}

void add_relight_files(CLI::App& app, RelightCommand& command) {
  app.add_option("IN", command.transport, "FILE.rad, as --save-transport wrote it")->required();
  app.add_option("OUT", command.output, "Output file: .glb, .gltf (with a .bin beside it) or .embedded.gltf")
      ->required();
  app.option_defaults()->group("Input");
  add(app,
      {"--source", "FILE", "none",
       "The glTF that was baked: refuse the transport if its geometry has changed since then"},
      [&command](const std::string& text) { command.options.source = text; });
}

void add_changes(CLI::App& app, RelightOptions& options) {
  app.option_defaults()->group("Light");
  add_repeated(
      app,
      {"--light", "NAME=[R,G,B,]I", "none",
       "Another colour (linear, not negative) and intensity (candela or lux, as the file has it) of the light "
       "NAME, or of the light at the node NAME, or of the sun; R,G,B or I alone keep the other. May be repeated"},
      [&options](const std::string& text) { options.lights.push_back(parse_light(text)); });
  add_repeated(app,
               {"--emissive", "NAME=R,G,B|F", "none",
                "Another luminance of what the material NAME emits, in cd/m2, before its texture, or what it is "
                "multiplied by. May be repeated"},
               [&options](const std::string& text) { options.emissive.push_back(parse_emissive(text)); });
  add(app,
      {"--sky", "R,G,B", "none",
       "Another luminance of the sky, in cd/m2; where the sky of the bake is an image, what multiplies it"},
      [&options](const std::string& text) { options.sky = parse_triple(text, {}); })
      ->join(',');
  app.option_defaults()->group("Surfaces");
  add_repeated(app,
               {"--reflectance", "NAME=R,G,B", "none",
                "Another base colour factor of the material NAME, linear, 0 to 1, before its texture. May be repeated"},
               [&options](const std::string& text) { options.reflectance.push_back(parse_reflectance(text)); });
}

void add_relight_output(CLI::App& app, RelightCommand& command) {
  app.option_defaults()->group("Output");
  add(app,
      {"--exposure", "K|auto", "as baked",
       "Factor from luminance to colour, in m2/cd, above 0, or the one that a bake would choose"},
      [&command](const std::string& text) {
        command.options.exposure.reset();
        command.options.auto_exposure = text == "auto";
        if (text != "auto") command.options.exposure = parse_number(text, {.open = true});
      });
  add(app,
      {"--threads", "COUNT", std::to_string(command.options.threads),
       "Threads, up to 1024; 0 uses every core. The result is the same for any number"},
      [&command](const std::string& text) { command.options.threads = parse_integer(text, 0, 1024); });
  add_json_option(app, command.json);
}

/// The parser and where its values go. Not movable: the parser's callbacks point into it.
struct RelightParser {
  RelightCommand command;
  CLI::App app{std::string(kRelightDescription), "gltf-radiosity relight"};

  RelightParser() {
    app.formatter(std::make_shared<HelpFormatter>());
    app.footer(std::string(kRelightFooter));
    add_relight_files(app, command);
    add_changes(app, command.options);
    add_relight_output(app, command);
    app.option_defaults()->group("Other");
    add_version_and_help(app);
  }
  RelightParser(const RelightParser&) = delete;
  RelightParser& operator=(const RelightParser&) = delete;
};

void finish_relight(const RelightCommand& command) {
  if (command.transport.empty() || command.output.empty()) {
    throw CLI::ValidationError("IN and OUT must not be empty");
  }
  const std::array files{command.transport, command.output, command.options.source};
  if (command.json != "-") check_that_differs("--json", command.json, files);
  check_that_differs("OUT", command.output, std::array{command.options.source});
}

}  // namespace

bool is_relight_command(std::span<const char* const> arguments) { return names_subcommand(arguments, "relight"); }

std::variant<RelightCommand, Ending> parse_relight_command(std::span<const char* const> arguments) {
  return parse_subcommand<RelightParser>(arguments, finish_relight);
}

std::string relight_help_text() { return RelightParser().app.help(); }

}  // namespace gltf_radiosity::tools
