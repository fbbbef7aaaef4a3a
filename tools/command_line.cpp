#include "tools/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>
#include <variant>

#include "tools/exit_code.h"
#include "tools/help_text.h"
#include "tools/option_values.h"

namespace gltf_radiosity::tools {
namespace {

// ---- values that have names ----

constexpr Choices<Refine, 2> kRefine{{{"none", Refine::kNone}, {"uniform", Refine::kUniform}}};
constexpr Choices<Metals, 2> kMetals{{{"diffuse", Metals::kDiffuse}, {"black", Metals::kBlack}}};
constexpr Choices<LightUnits, 3> kLightUnits{
    {{"auto", LightUnits::kAuto}, {"si", LightUnits::kSi}, {"blender", LightUnits::kBlender}}};
constexpr Choices<VisibilityMethod, 3> kVisibility{
    {{"raster", VisibilityMethod::kRaster}, {"rays", VisibilityMethod::kRays}, {"auto", VisibilityMethod::kAuto}}};
constexpr Choices<SolverMethod, 2> kSolver{
    {{"progressive", SolverMethod::kProgressive}, {"gathering", SolverMethod::kGathering}}};
constexpr Choices<ColorType, 3> kColorType{
    {{"float", ColorType::kFloat}, {"u16", ColorType::kU16}, {"u8", ColorType::kU8}}};
constexpr Choices<ProgressStyle, 4> kProgress{{{"bar", ProgressStyle::kBar},
                                               {"plain", ProgressStyle::kPlain},
                                               {"none", ProgressStyle::kNone},
                                               {"auto", ProgressStyle::kAuto}}};

/// What --quality sets unless the option itself is given.
struct Quality {
  int hemicube = 0;
  int max_patches = 0;
};
constexpr Quality kMedium{Options{}.hemicube, Options{}.max_patches};
constexpr Choices<Quality, 3> kQuality{{{"draft", {16, 1500}}, {"medium", kMedium}, {"high", {64, 12000}}}};

// ---- how an option is declared ----

/// The part of an option that people read.
struct OptionText {
  std::string name;
  std::string type;         ///< what to write after the name
  std::string preset;       ///< the default as one would write it
  std::string description;  ///< with the unit
};

/// Adds an option whose value `read` takes; what it throws as BadValue becomes a message that names the option.
CLI::Option* add(CLI::App& app, const OptionText& text, const std::function<void(const std::string&)>& read) {
  const auto callback = [name = text.name, read](const std::string& value) {
    try {
      read(value);
    } catch (const BadValue& bad) {
      throw CLI::ValidationError(name, bad.what());
    }
  };
  return app.add_option_function<std::string>(text.name, callback, text.description)
      ->type_name(text.type)
      ->default_str(text.preset)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
}

/// Adds an option that chooses one of the named values.
template <typename Value, std::size_t count>
void add_choice(CLI::App& app, const std::string& name, const std::string& description, Value& value,
                const Choices<Value, count>& choices) {
  add(app, {name, names_of(choices), name_of(value, choices), description},
      [&value, &choices](const std::string& text) { value = parse_choice(text, choices); });
}

// ---- the options, group by group ----

void add_files(CLI::App& app, CommandLine& line) {
  app.add_option("IN", line.input, "The scene: a .glb or .gltf file")->required()->configurable(false);
  app.add_option("OUT", line.output,
                 "The baked scene: .glb, .gltf (with a .bin beside it) or .embedded.gltf (all in one file)")
      ->required()
      ->configurable(false);
}

void add_mesh_options(CLI::App& app, Options& options) {
  app.option_defaults()->group("Mesh: how finely the light is stored");
  add_choice(app, "--refine", "none keeps the triangles of the file; uniform cuts them to --patch-size", options.refine,
             kRefine);
  add(app,
      {"--patch-size", "METRES|auto", "auto",
       "Longest edge of the baked mesh, in metres; auto (or 0) chooses one that suits the scene"},
      [&options](const std::string& text) { options.patch_size = text == "auto" ? 0.0 : parse_number(text, {}); });
  app.add_option_function<std::vector<std::string>>(
         "--subdivide",
         [&options](const std::vector<std::string>& texts) {
           try {
             for (const std::string& text : texts) options.subdivide.push_back(parse_subdivide(text));
           } catch (const BadValue& bad) {
             throw CLI::ValidationError("--subdivide", bad.what());
           }
         },
         "Cut each triangle of the node NAME in four, LEVEL times (0 to 8), whatever --refine and "
         "--patch-size say; may be repeated")
      ->type_name("NAME=LEVEL")
      ->default_str("none")
      ->allow_extra_args(false);
}

void set_sky(const std::variant<std::array<double, 3>, std::string>& sky, Options& options) {
  options.sky.reset();
  options.sky_file.clear();
  if (const auto* luminance = std::get_if<0>(&sky)) options.sky = *luminance;
  if (const auto* file = std::get_if<1>(&sky)) options.sky_file = *file;
}

void add_light_options(CLI::App& app, Options& options) {
  app.option_defaults()->group("Light");
  add(app,
      {"--sky", "R,G,B|FILE.hdr", "none",
       "The open sky: its luminance in cd/m2 (red, green, blue, linear Rec. 709, not negative), or a Radiance HDR "
       "image "
       "in cd/m2, equirectangular, up to 16384 x 8192, with +x in its middle and +z to the right. Replaces an "
       "EXT_lights_image_based of the file"},
      [&options](const std::string& text) { set_sky(parse_sky(text), options); })
      ->join(',');
  add(app,
      {"--sky-rotation", "DEG", fmt::format("{}", options.sky_rotation_degrees),
       "Turns the sky about y, -360 to 360 degrees: what stood at azimuth 0 then stands at DEG"},
      [&options](const std::string& text) {
        options.sky_rotation_degrees = parse_number(text, {-360.0, 360.0});
      });
  add(app,
      {"--sun", "EL,AZ,LUX", "none",
       "The sun: elevation -90 to 90 and azimuth -360 to 360 in degrees (it stands at (cos EL sin AZ, sin EL, cos EL "
       "cos "
       "AZ), y up), and the lux it brings to a surface that faces it"},
      [&options](const std::string& text) { options.sun = parse_sun(text); })
      ->join(',');
  app.add_flag_callback(
      "--no-default-sky", [&options] { options.default_sky = false; },
      "Bake a scene without any light black, instead of under a white sky of 1 cd/m2 (default: off)");
  add_choice(app, "--metals", "Metals reflect their base colour as if they were painted (diffuse), or nothing (black)",
             options.metals, kMetals);
  add_choice(app, "--light-units",
             "Lights of the file: candela and lux as glTF says (si), 683 times too bright as Blender writes them "
             "(blender), or what the file's generator suggests (auto)",
             options.light_units, kLightUnits);
}

void add_quality(CLI::App& app, std::optional<Quality>& quality) {
  std::string description = "Sets two options at once, which win if given themselves:";
  for (const auto& [name, preset] : kQuality) {
    description += fmt::format("\n{}: --hemicube {} --max-patches {}", name, preset.hemicube, preset.max_patches);
  }
  add(app, {"--quality", names_of(kQuality), "medium", description},
      [&quality](const std::string& text) { quality = parse_choice(text, kQuality); });
}

void add_transport_options(CLI::App& app, Options& options, std::optional<Quality>& quality) {
  app.option_defaults()->group("Transport: how exactly the light is computed");
  add_quality(app, quality);
  add(app,
      {"--hemicube", "CELLS", std::to_string(options.hemicube),
       "Cells along one edge of the hemicubes that look around, even, 2 to 512"},
      [&options](const std::string& text) {
        options.hemicube = parse_integer(text, 2, 512);
        if (options.hemicube % 2 != 0) throw BadValue(text + " is not even");
      });
  add(app,
      {"--max-patches", "COUNT", std::to_string(options.max_patches),
       "Surfaces are grouped into at most this many patches that send light; more see finer indirect light"},
      [&options](const std::string& text) { options.max_patches = parse_integer(text, 1, 100'000'000); });
  add(app,
      {"--residual", "SHARE", fmt::format("{}", options.residual),
       "Stop when this share of the emitted light is still on its way, between 0 and 1"},
      [&options](const std::string& text) {
        options.residual = parse_number(text, {0.0, 1.0, true});
      });
  add_choice(app, "--visibility", "What fills the hemicubes: drawing triangles, tracing rays, or the faster of the two",
             options.visibility, kVisibility);
  add_choice(app, "--solver",
             "Shoot from the brightest patch first (progressive), or let all patches gather in turn (gathering)",
             options.solver, kSolver);
  add(app,
      {"--threads", "COUNT", std::to_string(options.threads),
       "Threads, up to 1024; 0 uses every core. The result is the same for any number"},
      [&options](const std::string& text) { options.threads = parse_integer(text, 0, 1024); });
}

void add_output_options(CLI::App& app, CommandLine& line) {
  Options& options = line.options;
  app.option_defaults()->group("Output");
  CLI::Option* const exposure = add(
      app,
      {"--exposure", "K|auto", "auto", "Factor from luminance to colour, in m2/cd, above 0: 1 shows 1 cd/m2 as white"},
      [&options](const std::string& text) {
        options.exposure.reset();
        if (text != "auto") options.exposure = parse_number(text, {.open = true});
      });
  add(app, {"--ev100", "EV", "none", "The exposure of a camera at ISO 100, -30 to 30: K = 1 / (1.2 x 2^EV)"},
      [&options](const std::string& text) {
        options.exposure = 1.0 / (1.2 * std::exp2(parse_number(text, {-30.0, 30.0})));
      })
      ->excludes(exposure);
  add_choice(app, "--color-type", "How COLOR_0 is stored: float, or normalised integers of 16 or 8 bits",
             options.color_type, kColorType);
  add(app, {"--json", "FILE", "none", "Write a report for programs, also when the bake fails; - writes it to stdout"},
      [&line](const std::string& text) { line.json = text; });
  add_choice(app, "--progress",
             "On stderr: a bar, plain lines, or nothing but warnings and errors; auto is a bar on a terminal and lines "
             "elsewhere",
             line.progress, kProgress);
}

void add_other_options(CLI::App& app) {
  app.option_defaults()->group("Other");
  app.set_config("--config", "",
                 "Read options from a TOML file, without their dashes: patch-size = 0.1; the command "
                 "line wins (default: none)")
      ->type_name("FILE");
  app.allow_config_extras(CLI::config_extras_mode::error);
  app.set_version_flag("--version", fmt::format("gltf-radiosity {}", version()), "Print the version and exit");
  app.set_help_flag("-h,--help", "Print this text and exit")->group("Other");
}

// ---- the whole ----

/// The parser and where its values go. Not movable: the parser's callbacks point into it.
struct Parser {
  CommandLine line;
  std::optional<Quality> quality;
  CLI::App app{std::string(kHelpDescription), "gltf-radiosity"};

  Parser() {
    app.formatter(std::make_shared<HelpFormatter>());
    app.footer(std::string(kHelpFooter));
    add_files(app, line);
    add_mesh_options(app, line.options);
    add_light_options(app, line.options);
    add_transport_options(app, line.options, quality);
    add_output_options(app, line);
    add_other_options(app);
  }
  Parser(const Parser&) = delete;
  Parser& operator=(const Parser&) = delete;
};

/// What is only known once every option has been read.
void finish(Parser& parser) {
  // Explicit options win over --quality, wherever either was given
  Options& options = parser.line.options;
  if (parser.quality && parser.app.count("--hemicube") == 0) options.hemicube = parser.quality->hemicube;
  if (parser.quality && parser.app.count("--max-patches") == 0) options.max_patches = parser.quality->max_patches;

  // The report must not replace the scene
  const auto same = [](const std::string& a, const std::string& b) {
    return std::filesystem::absolute(a).lexically_normal() == std::filesystem::absolute(b).lexically_normal();
  };
  const CommandLine& line = parser.line;
  if (line.input.empty() || line.output.empty()) throw CLI::ValidationError("IN and OUT must not be empty");
  if (!line.json.empty() && line.json != "-" && (same(line.json, line.input) || same(line.json, line.output))) {
    throw CLI::ValidationError("--json", "the report must be another file than IN and OUT");
  }
}

/// CLI11 says the same of unknown options and of lines that are no TOML, and calls both INI.
std::string config_mistake(std::string text) {
  constexpr std::string_view kUnknown = "INI was not able to parse ";
  if (text.starts_with(kUnknown)) text = "no such option: " + text.substr(kUnknown.size());
  return text;
}

Ending usage_error(const std::string& text) { return {kExitUsage, text + " (--help explains)"}; }

}  // namespace

std::variant<CommandLine, Ending> parse_command_line(std::span<const char* const> arguments) {
  Parser parser;
  try {
    parser.app.parse(static_cast<int>(arguments.size()), arguments.data());
    finish(parser);
    return parser.line;
  } catch (const CLI::CallForHelp&) {
    return Ending{kExitDone, parser.app.help()};
  } catch (const CLI::CallForVersion& version_text) {
    return Ending{kExitDone, std::string(version_text.what()) + "\n"};
  } catch (const CLI::ConfigError& mistake) {
    return usage_error("--config: " + config_mistake(mistake.what()));
  } catch (const CLI::FileError& mistake) {
    return usage_error(std::string("--config: ") + mistake.what());
  } catch (const CLI::Error& mistake) {
    return usage_error(mistake.what());
  }
}

std::string help_text() { return Parser().app.help(); }

}  // namespace gltf_radiosity::tools
