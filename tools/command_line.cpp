#include "tools/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/help_text.h"
#include "tools/option_values.h"
#include "tools/shared_options.h"

namespace gltf_radiosity::tools {
namespace {

// ---- values that have names ----

constexpr Choices<Refine, 3> kRefine{
    {{"none", Refine::kNone}, {"uniform", Refine::kUniform}, {"adaptive", Refine::kAdaptive}}};
constexpr Choices<ErrorSpace, 2> kErrorSpace{{{"display", ErrorSpace::kDisplay}, {"linear", ErrorSpace::kLinear}}};
constexpr Choices<VisibilityMethod, 3> kVisibility{
    {{"raster", VisibilityMethod::kRaster}, {"rays", VisibilityMethod::kRays}, {"auto", VisibilityMethod::kAuto}}};
constexpr Choices<FitMethod, 2> kFit{
    {{"least-squares", FitMethod::kLeastSquares}, {"interpolate", FitMethod::kInterpolate}}};
constexpr Choices<SolverMethod, 2> kSolver{
    {{"progressive", SolverMethod::kProgressive}, {"gathering", SolverMethod::kGathering}}};
constexpr Choices<ColorType, 3> kColorType{
    {{"float", ColorType::kFloat}, {"u16", ColorType::kU16}, {"u8", ColorType::kU8}}};

constexpr Choices<BakedLight, 3> kBakedLight{
    {{"direct", BakedLight::kDirect}, {"indirect", BakedLight::kIndirect}, {"both", BakedLight::kBoth}}};
constexpr Choices<TwoSided, 2> kTwoSided{{{"front", TwoSided::kFront}, {"lit", TwoSided::kLit}}};
constexpr Choices<LightGroupStorage, 4> kLightGroups{{{"none", LightGroupStorage::kNone},
                                                      {"morph", LightGroupStorage::kMorph},
                                                      {"attributes", LightGroupStorage::kAttributes},
                                                      {"files", LightGroupStorage::kFiles}}};
constexpr Choices<Target, 2> kTarget{{{"unlit", Target::kUnlit}, {"keep", Target::kKeep}}};
constexpr Choices<Engine, 7> kEngine{{{"three", Engine::kThree},
                                      {"babylon", Engine::kBabylon},
                                      {"godot", Engine::kGodot},
                                      {"unity", Engine::kUnity},
                                      {"unreal", Engine::kUnreal},
                                      {"blender", Engine::kBlender},
                                      {"any", Engine::kAny}}};

/// The --hemicube that --quality sets unless it is given itself.
const Choices<int, 3> kQuality{{{"draft", 8}, {"medium", Options{}.hemicube}, {"high", 32}}};

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
  add_choice(
      app, "--refine",
      "none keeps the triangles of the file; uniform cuts them to --patch-size; adaptive cuts them where the light "
      "needs it, until --max-error or --max-vertices is reached",
      options.refine, kRefine);
  add(app,
      {"--max-error", "SHARE", fmt::format("{}", options.max_error),
       "adaptive: the mesh is fine enough when the estimated error is not above this, as relative RMSE, above 0"},
      [&options](const std::string& text) { options.max_error = parse_number(text, {.open = true}); });
  add(app,
      {"--max-vertices", "COUNT|auto", "auto",
       "adaptive: the mesh has at most this many vertices, or those of the file if they are more; auto is those of the "
       "file and 16000 more"},
      [&options](const std::string& text) {
        options.max_vertices = text == "auto" ? 0 : static_cast<std::uint64_t>(parse_integer(text, 1, 1'000'000'000));
      });
  add_choice(app, "--error-space",
             "adaptive: which triangles are cut first, those with most error as the eye sees it (display), or in plain "
             "luminance (linear)",
             options.error_space, kErrorSpace);
  add(app,
      {"--patch-size", "METRES|auto", "auto",
       "Longest edge of the baked mesh, in metres, that adaptive starts from; auto (or 0) chooses one that suits the "
       "scene"},
      [&options](const std::string& text) { options.patch_size = text == "auto" ? 0.0 : parse_number(text, {}); });
  add_repeated(app,
               {"--subdivide", "NAME=LEVEL", "none",
                "Cut each triangle of the node NAME in four, LEVEL times (0 to 8), whatever --refine and --patch-size "
                "say; may be repeated"},
               [&options](const std::string& text) { options.subdivide.push_back(parse_subdivide(text)); });
  app.add_flag_callback(
      "--simplify", [&options] { options.simplify = true; },
      "Leave out vertices that neither shape, attributes nor light need; nowhere does the light change by more than "
      "--max-error of its mean (default: off)");
}

void add_node_options(CLI::App& app, Options& options) {
  app.option_defaults()->group("Nodes: what receives light");
  add_repeated(app,
               {"--select", "NAME", "none",
                "Only nodes of this name receive light, and all below them; * and ? stand for what you like; may be "
                "repeated. The others still cast shadows and send light"},
               [&options](const std::string& text) { options.select.push_back(text); });
  add_repeated(app,
               {"--exclude", "NAME", "none",
                "Nodes of this name receive no light, nor does what is below them; may be repeated"},
               [&options](const std::string& text) { options.exclude.push_back(text); });
}

void add_bake_option(CLI::App& app, Options& options) {
  add_choice(app, "--bake",
             "What is baked: light straight from lamps, lights and sky (direct), what surfaces reflect (indirect), or "
             "both",
             options.bake, kBakedLight);
}

void add_quality(CLI::App& app, std::optional<int>& quality) {
  std::string description = "Sets --hemicube, unless it is given itself; the number of patches goes with it:";
  for (const auto& [name, hemicube] : kQuality) description += fmt::format("\n{}: --hemicube {}", name, hemicube);
  add(app, {"--quality", names_of(kQuality), "medium", description},
      [&quality](const std::string& text) { quality = parse_choice(text, kQuality); });
}

void add_transport_options(CLI::App& app, Options& options, std::optional<int>& quality) {
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
      {"--max-patches", "COUNT|auto", "auto",
       "Surfaces are grouped into at most this many patches that send light; more see finer indirect light; auto is a "
       "third of the baked triangles, 1000 to 30000 with hemicubes of 16 cells"},
      [&options](const std::string& text) {
        options.max_patches = text == "auto" ? 0 : parse_integer(text, 1, 100'000'000);
      });
  add(app,
      {"--residual", "SHARE", fmt::format("{}", options.residual),
       "Stop when this share of the emitted light is still on its way, between 0 and 1"},
      [&options](const std::string& text) {
        options.residual = parse_number(text, {0.0, 1.0, true});
      });
  add_choice(app, "--visibility", "What fills the hemicubes: drawing triangles, tracing rays, or the faster of the two",
             options.visibility, kVisibility);
  add_choice(app, "--fit",
             "From samples to vertices: the closest light that is linear in each element (least-squares), or the light "
             "around each vertex (interpolate)",
             options.fit, kFit);
  add(app,
      {"--max-memory", "SIZE", "75 %",
       "Memory that the whole bake may take, as 512M or 8G, at least 64M: half of what the scene leaves holds form "
       "factors, older ones are computed again when needed; the mesh stops growing in time. Unless given, of what the "
       "machine or the control groups of the process have"},
      [&options](const std::string& text) { options.max_memory = parse_bytes(text); });
  add(app,
      {"--time-limit", "SECONDS", "none",
       "Stop in time and write the light that there is by then, with exit code 4; above 0. The bytes then depend on "
       "the "
       "machine"},
      [&options](const std::string& text) { options.time_limit = parse_number(text, {.open = true}); });
  add_choice(app, "--solver",
             "Shoot from the brightest patch first (progressive), or let all patches gather in turn (gathering)",
             options.solver, kSolver);
  add_threads_option(app, options);
}

void add_style(CLI::App& app, Options& options) {
  add_choice(app, "--engine",
             "Choose --color-type and --scale-to-factor as the engine needs them, unless they are given themselves",
             options.engine, kEngine);
  add(app,
      {"--color-type", names_of(kColorType), "float",
       "How COLOR_0 is stored: float, or normalised integers of 16 or 8 bits, the latter dithered. Unless given, u16 "
       "with --meshopt"},
      [&options](const std::string& text) { options.color_type = parse_choice(text, kColorType); });
  CLI::Option* const scale = app.add_flag_callback(
      "--scale-to-factor", [&options] { options.scale_to_factor = true; },
      "For engines that store 8 bits: scale the colours of each primitive up to white, and the base colour factor of "
      "its material down (default: off)");
  app.add_flag_callback(
         "--no-scale-to-factor", [&options] { options.scale_to_factor = false; },
         "Do not, whatever --engine says (default: off)")
      ->excludes(scale);
  add_choice(
      app, "--target",
      "Materials show COLOR_0 and nothing else (unlit), or stay as they are, lit by the engine (keep): COLOR_0 is "
      "then light without their colour",
      options.target, kTarget);
  add_choice(app, "--two-sided",
             "What surfaces show whose front no light can reach and whose back it can, if they are visible from both "
             "sides: their front, which is black (front), or their back (lit)",
             options.two_sided, kTwoSided);
  add(app,
      {"--radiance-attribute", "NAME", "none",
       "Write the light of COLOR_0 a second time, as floats without a limit, into the custom attribute _NAME"},
      [&options](const std::string& text) { options.radiance_attribute = parse_attribute_name(text); });
  add_choice(app, "--light-groups",
             "Keep the light of each group of lamps apart, to be dimmed later: as morph targets of COLOR_0 (morph), as "
             "attributes _LIGHT_NAME (attributes), or in files OUT.NAME (files)",
             options.light_groups, kLightGroups);
  add_repeated(app,
               {"--group", "NAME=PATTERN", "none",
                "Lights and emissive materials of this name, or at nodes of it, belong to the group NAME (*, ? and "
                "[ab] stand for others); may be repeated"},
               [&options](const std::string& text) { options.groups.push_back(parse_group(text)); });
  app.add_flag_callback(
      "--strip-lights", [&options] { options.strip_lights = true; },
      "Leave the lights of the file out of the output, punctual and image based ones: their light is in the colours "
      "now "
      "(default: off)");
}

/// What --draco without a number stands for.
constexpr const char* kColorBits = "16";

void add_compression(CLI::App& app, Options& options) {
  CLI::Option* const draco =
      add(app,
          {"--draco", "[BITS]", "off",
           fmt::format(
               "Compress the triangles with Draco (KHR_draco_mesh_compression), colours of floats to BITS, 8 to 24, "
               "{} unless given; integers stay exact",
               kColorBits)},
          [&options](const std::string& text) { options.draco_bits = parse_integer(text, 8, 24); });
  app.add_flag_callback(
         "--meshopt", [&options] { options.meshopt = true; },
         "Compress the triangles with meshoptimizer (EXT_meshopt_compression); excludes --draco (default: off)")
      ->excludes(draco);
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
  add_style(app, options);
  add_compression(app, options);
  app.add_flag_callback(
      "--force", [&options] { options.force = true; }, "OUT may replace IN, or a buffer or image of it (default: off)");
  add(app,
      {"--save-transport", "FILE.rad", "none",
       "Keep what other lights and reflectances take, for gltf-radiosity relight. The light of each lamp and each "
       "light is "
       "then computed apart, which takes longer"},
      [&options](const std::string& text) { options.save_transport = text; });
  add_json_option(app, line.json);
  add_progress_option(app, line.progress);
}

void add_cache_options(CLI::App& app, Options& options) {
  app.option_defaults()->group("Cache");
  add(app,
      {"--cache", "DIR", "none",
       "Keep results in this folder, which is made if there is none: a second bake of the same content takes the time "
       "of "
       "reading and writing, another lighting of the same shapes finds its form factors. Many processes may share it"},
      [&options](const std::string& text) { options.cache = text; });
  add(app,
      {"--cache-size", "SIZE", "4G",
       "What the folder may grow to, as 512M or 8G, at least 64M: what was used longest ago goes first"},
      [&options](const std::string& text) { options.cache_size = parse_bytes(text); });
}

void add_batch_options(CLI::App& app, CommandLine& line) {
  app.option_defaults()->group("Many files");
  CLI::Option* const batch = app.add_flag_callback(
      "--batch", [&line] { line.batch = true; },
      "Bake many files: IN is a folder, whose .glb and .gltf are baked with all below it, or a text file of paths, one "
      "a "
      "line (- for standard input), and OUT is a folder. Each file is baked in a process of its own, whatever happens "
      "to the others (default: off)");
  add(app,
      {"--jobs", "COUNT|auto", "auto",
       "Files that a batch bakes at once, sharing --threads and --max-memory; auto is one for each thread"},
      [&line](const std::string& text) { line.jobs = text == "auto" ? 0 : parse_integer(text, 1, 1024); })
      ->needs(batch);
}

void add_other_options(CLI::App& app) {
  app.option_defaults()->group("Other");
  app.set_config("--config", "",
                 "Read options from a TOML file, without their dashes: patch-size = 0.1; the command "
                 "line wins (default: none)")
      ->type_name("FILE");
  app.allow_config_extras(CLI::config_extras_mode::error);
  add_version_and_help(app);
}

// ---- the whole ----

/// The parser and where its values go. Not movable: the parser's callbacks point into it.
struct Parser {
  CommandLine line;
  std::optional<int> quality;
  CLI::App app{std::string(kHelpDescription), "gltf-radiosity"};

  Parser() {
    app.formatter(std::make_shared<HelpFormatter>());
    app.footer(std::string(kHelpFooter));
    add_files(app, line);
    add_input_options(app, line.options);
    add_mesh_options(app, line.options);
    add_node_options(app, line.options);
    add_light_options(app, line.options);
    add_bake_option(app, line.options);
    add_transport_options(app, line.options, quality);
    add_output_options(app, line);
    add_cache_options(app, line.options);
    add_batch_options(app, line);
    add_other_options(app);
  }
  Parser(const Parser&) = delete;
  Parser& operator=(const Parser&) = delete;
};

/// What is only known once every option has been read.
void finish(Parser& parser) {
  // An explicit --hemicube wins over --quality, wherever either was given
  Options& options = parser.line.options;
  if (parser.quality && parser.app.count("--hemicube") == 0) options.hemicube = *parser.quality;

  // The report must not replace the scene
  const CommandLine& line = parser.line;
  if (line.input.empty() || line.output.empty()) throw CLI::ValidationError("IN and OUT must not be empty");
  const std::string& transport = line.options.save_transport;
  check_that_differs("--save-transport", transport, std::array{line.input, line.output, line.json});
  if (line.batch && !transport.empty()) throw CLI::ValidationError("--save-transport", "is one file: excludes --batch");
  if (!transport.empty()) options.also_written.push_back(transport);
  if (line.json == "-") return;
  check_that_differs("--json", line.json, std::array{line.input, line.output});
  options.also_written.push_back(line.json);
}

/// Gives --draco its number where it has none: CLI11 would take the next argument for it, which may be a file.
std::vector<const char*> with_color_bits(std::span<const char* const> arguments) {
  std::vector<const char*> completed;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    completed.push_back(arguments[i]);
    if (std::string_view(arguments[i]) != "--draco") continue;
    const std::string_view next = i + 1 < arguments.size() ? arguments[i + 1] : "";
    const bool is_number =
        !next.empty() && std::all_of(next.begin(), next.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (!is_number) completed.push_back(kColorBits);
  }
  return completed;
}

}  // namespace

std::variant<CommandLine, Ending> parse_command_line(std::span<const char* const> arguments) {
  Parser parser;
  const std::vector<const char*> completed = with_color_bits(arguments);
  if (auto ending = parse_with(parser.app, completed, [&parser] { finish(parser); })) return std::move(*ending);
  return std::move(parser.line);
}

std::string help_text() { return Parser().app.help(); }

}  // namespace gltf_radiosity::tools
