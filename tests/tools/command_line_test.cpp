#include "tools/command_line.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace gltf_radiosity::tools {
namespace {

using Arguments = std::vector<std::string>;

std::variant<CommandLine, Ending> parse(const Arguments& arguments) {
  std::vector<const char*> pointers = {"gltf-radiosity"};
  for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
  return parse_command_line(pointers);
}

/// Parses IN, OUT and `more`, and expects that to be a bake.
CommandLine parse_bake(const Arguments& more) {
  Arguments arguments = {"in.glb", "out.glb"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const auto parsed = parse(arguments);
  if (const auto* const ending = std::get_if<Ending>(&parsed)) {
    ADD_FAILURE() << ending->text;
    return {};
  }
  return std::get<CommandLine>(parsed);
}

/// Parses `arguments` and expects a mistake; its message.
std::string parse_mistake(const Arguments& arguments) {
  const auto parsed = parse(arguments);
  const auto* const ending = std::get_if<Ending>(&parsed);
  if (ending == nullptr || ending->exit_code != 2) return "accepted";
  return ending->text;
}

/// A configuration file that goes away with the test.
class ConfigFile {
 public:
  explicit ConfigFile(const std::string& text) {
    const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(testing::TempDir()) / (std::string("gltf_radiosity_") + test->name() + ".toml");
    std::ofstream(path_) << text;
  }
  ~ConfigFile() { std::filesystem::remove(path_); }
  ConfigFile(const ConfigFile&) = delete;
  ConfigFile& operator=(const ConfigFile&) = delete;
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

TEST(CommandLine, NeedsOnlyTwoFiles) {
  const CommandLine line = parse_bake({});
  EXPECT_EQ(line.input, "in.glb");
  EXPECT_EQ(line.output, "out.glb");
  EXPECT_EQ(line.json, "");
  EXPECT_EQ(line.progress, ProgressStyle::kAuto);
}

TEST(CommandLine, DefaultsAreThoseOfTheLibrary) {
  const Options parsed = parse_bake({}).options;
  const Options library;
  EXPECT_EQ(parsed.scene, library.scene);
  EXPECT_EQ(parsed.refine, library.refine);
  EXPECT_EQ(parsed.patch_size, library.patch_size);
  EXPECT_EQ(parsed.subdivide, library.subdivide);
  EXPECT_EQ(parsed.sky, library.sky);
  EXPECT_EQ(parsed.sky_file, library.sky_file);
  EXPECT_EQ(parsed.sky_rotation_degrees, library.sky_rotation_degrees);
  EXPECT_EQ(parsed.sun.has_value(), library.sun.has_value());
  EXPECT_EQ(parsed.default_sky, library.default_sky);
  EXPECT_EQ(parsed.metals, library.metals);
  EXPECT_EQ(parsed.light_units, library.light_units);
  EXPECT_EQ(parsed.hemicube, library.hemicube);
  EXPECT_EQ(parsed.visibility, library.visibility);
  EXPECT_EQ(parsed.solver, library.solver);
  EXPECT_EQ(parsed.residual, library.residual);
  EXPECT_EQ(parsed.max_patches, library.max_patches);
  EXPECT_EQ(parsed.threads, library.threads);
  EXPECT_EQ(parsed.exposure, library.exposure);
  EXPECT_EQ(parsed.color_type, library.color_type);
}

TEST(CommandLine, ReadsWhichSceneIsMeant) {
  EXPECT_EQ(parse_bake({"--scene", "3"}).options.scene, 3U);
  EXPECT_EQ(parse_bake({"--scene", "3", "--scene", "auto"}).options.scene, std::nullopt);
}

TEST(CommandLine, ReadsTheOptionsOfTheMesh) {
  const Options options =
      parse_bake({"--refine", "none", "--patch-size", "0.1", "--subdivide", "A=1", "--subdivide", "B c=3"}).options;
  EXPECT_EQ(options.refine, Refine::kNone);
  EXPECT_EQ(options.patch_size, 0.1);
  EXPECT_EQ(options.subdivide, (std::vector<std::pair<std::string, int>>{{"A", 1}, {"B c", 3}}));
  EXPECT_EQ(parse_bake({"--patch-size", "0.1", "--patch-size", "auto"}).options.patch_size, 0.0);
}

TEST(CommandLine, ReadsTheOptionsOfTheLight) {
  const Options options = parse_bake({"--sky", "0.1,0.2,0.3", "--sun", "40,120,80000", "--no-default-sky", "--metals",
                                      "black", "--light-units", "blender"})
                              .options;
  EXPECT_EQ(options.sky, (std::array{0.1, 0.2, 0.3}));
  ASSERT_TRUE(options.sun.has_value());
  EXPECT_EQ(options.sun->azimuth_degrees, 120.0);
  EXPECT_FALSE(options.default_sky);
  EXPECT_EQ(options.metals, Metals::kBlack);
  EXPECT_EQ(options.light_units, LightUnits::kBlender);
}

TEST(CommandLine, ASkyIsALuminanceOrAFile) {
  const Options file = parse_bake({"--sky", "skies/noon.hdr", "--sky-rotation", "-30"}).options;
  EXPECT_EQ(file.sky, std::nullopt);
  EXPECT_EQ(file.sky_file, "skies/noon.hdr");
  EXPECT_EQ(file.sky_rotation_degrees, -30.0);
}

TEST(CommandLine, ReadsTheOptionsOfTheTransport) {
  const Options options =
      parse_bake({"--hemicube", "64", "--visibility", "raster", "--solver", "gathering", "--residual", "0.01",
                  "--max-patches", "99", "--threads", "3", "--fit", "interpolate", "--max-memory", "2G"})
          .options;
  EXPECT_EQ(options.hemicube, 64);
  EXPECT_EQ(options.visibility, VisibilityMethod::kRaster);
  EXPECT_EQ(options.solver, SolverMethod::kGathering);
  EXPECT_EQ(options.residual, 0.01);
  EXPECT_EQ(options.max_patches, 99);
  EXPECT_EQ(options.threads, 3);
  EXPECT_EQ(options.fit, FitMethod::kInterpolate);
  EXPECT_EQ(options.max_memory, std::uint64_t{2} << 30U);
}

TEST(CommandLine, ReadsTheOptionsOfTheOutput) {
  const CommandLine line =
      parse_bake({"--exposure", "0.5", "--color-type", "u16", "--json", "-", "--progress", "plain"});
  EXPECT_EQ(line.options.exposure, 0.5);
  EXPECT_EQ(line.options.color_type, ColorType::kU16);
  EXPECT_EQ(line.json, "-");
  EXPECT_EQ(line.progress, ProgressStyle::kPlain);
  EXPECT_EQ(parse_bake({"--exposure", "auto"}).options.exposure, std::nullopt);
}

TEST(CommandLine, DracoTakesANumberOrNone) {
  EXPECT_EQ(parse_bake({}).options.draco_bits, 0);
  EXPECT_EQ(parse_bake({"--draco"}).options.draco_bits, 16);
  EXPECT_EQ(parse_bake({"--draco", "12"}).options.draco_bits, 12);
  EXPECT_EQ(parse_bake({"--draco=14"}).options.draco_bits, 14);
  EXPECT_EQ(parse_bake({"--draco", "--threads", "2"}).options.draco_bits, 16);
  const std::array arguments = {"gltf-radiosity", "--draco", "in.glb", "out.glb"};
  EXPECT_TRUE(std::holds_alternative<CommandLine>(parse_command_line(arguments)));
}

TEST(CommandLine, ReadsHowTheLightIsWritten) {
  const Options options =
      parse_bake({"--engine", "godot", "--no-scale-to-factor", "--target", "keep", "--two-sided", "lit",
                  "--strip-lights", "--radiance-attribute", "LIGHT", "--meshopt", "--bake", "indirect"})
          .options;
  EXPECT_EQ(options.engine, Engine::kGodot);
  EXPECT_EQ(options.scale_to_factor, false);
  EXPECT_EQ(parse_bake({"--scale-to-factor"}).options.scale_to_factor, true);
  EXPECT_EQ(options.target, Target::kKeep);
  EXPECT_EQ(options.two_sided, TwoSided::kLit);
  EXPECT_TRUE(options.strip_lights && options.meshopt);
  EXPECT_EQ(options.radiance_attribute, "LIGHT");
  EXPECT_EQ(options.bake, BakedLight::kIndirect);
}

TEST(CommandLine, NodesAreNamedAsOftenAsOneLikes) {
  const Options options = parse_bake({"--select", "a*", "--exclude", "b", "--select", "c"}).options;
  EXPECT_EQ(options.select, (std::vector<std::string>{"a*", "c"}));
  EXPECT_EQ(options.exclude, std::vector<std::string>{"b"});
}

TEST(CommandLine, TakesTheExposureOfACamera) {
  EXPECT_DOUBLE_EQ(parse_bake({"--ev100", "0"}).options.exposure.value_or(0.0), 1.0 / 1.2);
  EXPECT_DOUBLE_EQ(parse_bake({"--ev100", "15"}).options.exposure.value_or(0.0), 1.0 / (1.2 * 32768.0));
  EXPECT_DOUBLE_EQ(parse_bake({"--ev100", "-2"}).options.exposure.value_or(0.0), 4.0 / 1.2);
  EXPECT_NE(parse_mistake({"in", "out", "--ev100", "1", "--exposure", "1"}).find("--exposure"), std::string::npos);
}

TEST(CommandLine, QualitySetsTheHemicubeUnlessThatIsGiven) {
  const Options medium = parse_bake({"--quality", "medium"}).options;
  EXPECT_EQ(medium.hemicube, Options{}.hemicube);
  const Options draft = parse_bake({"--quality", "draft"}).options;
  const Options high = parse_bake({"--quality", "high"}).options;
  EXPECT_LT(draft.hemicube, medium.hemicube);
  EXPECT_GT(high.hemicube, medium.hemicube);

  for (const Arguments& order :
       {Arguments{"--quality", "high", "--hemicube", "8"}, {"--hemicube", "8", "--quality=high"}}) {
    EXPECT_EQ(parse_bake(order).options.hemicube, 8);
  }
}

TEST(CommandLine, TheLastOfRepeatedOptionsCounts) {
  EXPECT_EQ(parse_bake({"--hemicube", "16", "--hemicube", "64"}).options.hemicube, 64);
}

TEST(CommandLine, EveryMistakeNamesTheOption) {
  const std::vector<Arguments> mistakes = {
      {"--refine", "maybe"},
      {"--scene", "-1"},
      {"--scene", "first"},
      {"--patch-size", "-1"},
      {"--patch-size", "nan"},
      {"--subdivide", "A"},
      {"--sky", "1,1"},
      {"--sky-rotation", "x"},
      {"--sky", "1,1,-1"},
      {"--sun", "40,0"},
      {"--metals", ""},
      {"--light-units", "x"},
      {"--hemicube", "31"},
      {"--hemicube", "32x"},
      {"--visibility", "gpu"},
      {"--solver", "magic"},
      {"--residual", "0"},
      {"--residual", "inf"},
      {"--max-patches", "0"},
      {"--threads", "-1"},
      {"--exposure", "0"},
      {"--exposure", "1e999"},
      {"--ev100", "bright"},
      {"--color-type", "u9"},
      {"--draco", "7"},
      {"--draco", "25"},
      {"--draco", "--meshopt"},
      {"--bake", "all"},
      {"--engine", "quake"},
      {"--target", "lit"},
      {"--two-sided", "both"},
      {"--radiance-attribute", "a b"},
      {"--radiance-attribute", ""},
      {"--quality", "ultra"},
      {"--progress", "loud"},
      {"--config", "no/such.toml"},
      {"--json", "out.glb"},
      {"--json", "./x/../in.glb"},
      {"--hemicube"},
      {"--no-such-option"},
  };
  for (const Arguments& mistake : mistakes) {
    Arguments arguments = {"in.glb", "out.glb"};
    arguments.insert(arguments.end(), mistake.begin(), mistake.end());
    const std::string message = parse_mistake(arguments);
    EXPECT_NE(message.find(mistake.front()), std::string::npos) << testing::PrintToString(mistake) << " -> " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(CommandLine, WantsTwoFilesAndNoMore) {
  EXPECT_NE(parse_mistake({}).find("IN"), std::string::npos);
  EXPECT_NE(parse_mistake({"in.glb"}).find("OUT"), std::string::npos);
  EXPECT_NE(parse_mistake({"a", "b", "c"}).find("c"), std::string::npos);
  EXPECT_NE(parse_mistake({"", "b"}), "accepted");
}

TEST(CommandLine, SavesTheTransportOfOneBakeBesideItsOtherFiles) {
  EXPECT_EQ(parse_bake({"--save-transport", "room.rad"}).options.save_transport, "room.rad");
  EXPECT_NE(parse_mistake({"in", "out", "--save-transport", "./out"}).find("--save-transport"), std::string::npos);
  EXPECT_NE(parse_mistake({"--batch", "in", "out", "--save-transport", "a.rad"}).find("excludes --batch"),
            std::string::npos);
}

TEST(CommandLine, TakesOptionsFromAFile) {
  const ConfigFile config(
      "patch-size = 0.5\nsky = [1, 2.5, 3]\nsubdivide = [\"A=1\", \"B=2\"]\nno-default-sky = true\nhemicube = 8\n"
      "max-patches = \"auto\"\nquality = \"high\"\ndraco = 12\nselect = [\"a*\", \"b\"]\nstrip-lights = true\n"
      "scene = 2\n");
  const Options options = parse_bake({"--config", config.path(), "--patch-size", "0.25"}).options;
  EXPECT_EQ(options.patch_size, 0.25);
  EXPECT_EQ(options.sky, (std::array{1.0, 2.5, 3.0}));
  EXPECT_EQ(options.subdivide, (std::vector<std::pair<std::string, int>>{{"A", 1}, {"B", 2}}));
  EXPECT_FALSE(options.default_sky);
  EXPECT_EQ(options.hemicube, 8);
  EXPECT_EQ(options.max_patches, 0);
  EXPECT_EQ(options.draco_bits, 12);
  EXPECT_EQ(options.select, (std::vector<std::string>{"a*", "b"}));
  EXPECT_TRUE(options.strip_lights);
  EXPECT_EQ(options.scene, 2U);
}

TEST(CommandLine, RefusesAFileWithMistakes) {
  for (const std::string text :
       {"no-such-option = 1", "hemicube = 31", "sky = [1, 2]", "IN = \"x.glb\"", "[[[", "[a]\nb = 1"}) {
    const ConfigFile config(text);
    EXPECT_NE(parse_mistake({"in", "out", "--config", config.path()}), "accepted") << text;
  }
}

TEST(CommandLine, HelpAndVersionEndWithoutAMistake) {
  for (const std::string option : {"--help", "-h", "--version"}) {
    const auto parsed = parse({option});
    ASSERT_TRUE(std::holds_alternative<Ending>(parsed)) << option;
    EXPECT_EQ(std::get<Ending>(parsed).exit_code, 0) << option;
    EXPECT_TRUE(std::get<Ending>(parsed).text.ends_with("\n")) << option;
  }
  EXPECT_EQ(std::get<Ending>(parse({"--version"})).text, "gltf-radiosity " + std::string(version()) + "\n");
  EXPECT_EQ(std::get<Ending>(parse({"--help"})).text, help_text());
}

}  // namespace
}  // namespace gltf_radiosity::tools
