#include "tools/shared_options.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <string_view>
#include <variant>
#include <vector>

#include "tools/exit_code.h"

namespace gltf_radiosity::tools {
namespace {

void set_sky(const std::variant<std::array<double, 3>, std::string>& sky, Options& options) {
  options.sky.reset();
  options.sky_file.clear();
  if (const auto* luminance = std::get_if<0>(&sky)) options.sky = *luminance;
  if (const auto* file = std::get_if<1>(&sky)) options.sky_file = *file;
}

constexpr Choices<Metals, 2> kMetals{{{"diffuse", Metals::kDiffuse}, {"black", Metals::kBlack}}};
constexpr Choices<LightUnits, 3> kLightUnits{
    {{"auto", LightUnits::kAuto}, {"si", LightUnits::kSi}, {"blender", LightUnits::kBlender}}};
constexpr Choices<ProgressStyle, 4> kProgress{{{"bar", ProgressStyle::kBar},
                                               {"plain", ProgressStyle::kPlain},
                                               {"none", ProgressStyle::kNone},
                                               {"auto", ProgressStyle::kAuto}}};

/// CLI11 says the same of unknown options and of lines that are no TOML, and calls both INI.
std::string config_mistake(std::string text) {
  constexpr std::string_view kUnknown = "INI was not able to parse ";
  if (text.starts_with(kUnknown)) text = "no such option: " + text.substr(kUnknown.size());
  return text;
}

Ending usage_error(const std::string& text) { return {kExitUsage, text + " (--help explains)"}; }

}  // namespace

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

CLI::Option* add_repeated(CLI::App& app, const OptionText& text, const std::function<void(const std::string&)>& read) {
  const auto callback = [name = text.name, read](const std::vector<std::string>& values) {
    try {
      for (const std::string& value : values) read(value);
    } catch (const BadValue& bad) {
      throw CLI::ValidationError(name, bad.what());
    }
  };
  return app.add_option_function<std::vector<std::string>>(text.name, callback, text.description)
      ->type_name(text.type)
      ->default_str(text.preset)
      ->allow_extra_args(false);
}

void add_input_options(CLI::App& app, Options& options) {
  app.option_defaults()->group("Input");
  add(app,
      {"--scene", "N|auto", "auto",
       "Which scene of the file, counted from 0; auto is the one that the file names, or the first. The others stay as "
       "they are"},
      [&options](const std::string& text) {
        options.scene.reset();
        if (text != "auto") options.scene = static_cast<std::uint32_t>(parse_integer(text, 0, 1'000'000'000));
      });
  app.add_flag_callback(
      "--allow-outside", [&options] { options.allow_outside = true; },
      "Buffers and images of a .gltf may lie outside its folder: absolute paths, .. and links that lead out "
      "(default: off)");
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

void add_threads_option(CLI::App& app, Options& options) {
  add(app,
      {"--threads", "COUNT", std::to_string(options.threads),
       "Threads, up to 1024; 0 uses every core. The result is the same for any number"},
      [&options](const std::string& text) { options.threads = parse_integer(text, 0, 1024); });
}

void add_json_option(CLI::App& app, std::string& json) {
  add(app, {"--json", "FILE", "none", "Write a report for programs, also after a failure; - writes it to stdout"},
      [&json](const std::string& text) { json = text; });
}

void add_progress_option(CLI::App& app, ProgressStyle& progress) {
  add_choice(app, "--progress",
             "On stderr: a bar, plain lines, or nothing but warnings and errors; auto is a bar on a terminal and lines "
             "elsewhere",
             progress, kProgress);
}

void add_version_and_help(CLI::App& app) {
  app.set_version_flag("--version", fmt::format("gltf-radiosity {}", version()), "Print the version and exit");
  app.set_help_flag("-h,--help", "Print this text and exit")->group("Other");
}

void check_that_differs(const std::string& option, const std::string& file, std::span<const std::string> others) {
  const auto place = [](const std::string& name) { return std::filesystem::absolute(name).lexically_normal(); };
  for (const std::string& other : others) {
    if (file.empty() || other.empty() || place(file) != place(other)) continue;
    throw CLI::ValidationError(option, "must be another file than IN and OUT");
  }
}

bool names_subcommand(std::span<const char* const> arguments, std::string_view name) {
  return arguments.size() > 1 && arguments[1] == name;
}

std::optional<Ending> parse_with(CLI::App& app, std::span<const char* const> arguments,
                                 const std::function<void()>& finish) {
  try {
    app.parse(static_cast<int>(arguments.size()), arguments.data());
    finish();
    return std::nullopt;
  } catch (const CLI::CallForHelp&) {
    return Ending{kExitDone, app.help()};
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

}  // namespace gltf_radiosity::tools
