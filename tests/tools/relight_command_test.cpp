#include "tools/relight_command.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tools/exit_code.h"

namespace gltf_radiosity::tools {
namespace {

std::variant<RelightCommand, Ending> parse(std::vector<const char*> options) {
  std::vector<const char*> arguments = {"gltf-radiosity", "relight", "a.rad", "b.glb"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return parse_relight_command(arguments);
}

RelightOptions options_of(const std::vector<const char*>& options) {
  const auto parsed = parse(options);
  const auto* command = std::get_if<RelightCommand>(&parsed);
  EXPECT_NE(command, nullptr) << std::get<Ending>(parsed).text;
  return command == nullptr ? RelightOptions{} : command->options;
}

std::string mistake_of(const std::vector<const char*>& options) {
  const auto parsed = parse(options);
  const auto* ending = std::get_if<Ending>(&parsed);
  EXPECT_NE(ending, nullptr);
  EXPECT_EQ(ending == nullptr ? 0 : ending->exit_code, kExitUsage);
  return ending == nullptr ? "" : ending->text;
}

TEST(RelightCommand, IsAskedForByItsName) {
  const std::vector<const char*> relight = {"gltf-radiosity", "relight"}, bake = {"gltf-radiosity", "./relight"};
  EXPECT_TRUE(is_relight_command(relight));
  EXPECT_FALSE(is_relight_command(bake));
}

TEST(RelightCommand, TakesColourAndIntensityOfALightOrOneOfBoth) {
  const RelightOptions options = options_of({"--light", "a=b=1,0.5,0.25,40", "--light", "c=7", "--light", "d=1,2,3"});
  ASSERT_EQ(options.lights.size(), 3U);
  EXPECT_EQ(options.lights[0].first, "a=b");
  EXPECT_EQ(options.lights[0].second.color, (std::array{1.0, 0.5, 0.25}));
  EXPECT_EQ(options.lights[0].second.intensity, 40.0);
  EXPECT_EQ(options.lights[1].second.color, std::nullopt);
  EXPECT_EQ(options.lights[1].second.intensity, 7.0);
  EXPECT_EQ(options.lights[2].second.color, (std::array{1.0, 2.0, 3.0}));
  EXPECT_EQ(options.lights[2].second.intensity, std::nullopt);
}

TEST(RelightCommand, TakesALuminanceOrAFactorForAnEmissiveMaterial) {
  const RelightOptions options = options_of({"--emissive", "lamp=2.5", "--emissive", "sign=1,2,3"});
  ASSERT_EQ(options.emissive.size(), 2U);
  EXPECT_EQ(options.emissive[0].second.scale, 2.5);
  EXPECT_EQ(options.emissive[0].second.luminance, std::nullopt);
  EXPECT_EQ(options.emissive[1].second.luminance, (std::array{1.0, 2.0, 3.0}));
}

TEST(RelightCommand, TakesASkyAReflectanceAnExposureAndASource) {
  const RelightOptions options =
      options_of({"--sky", "1,2,3", "--reflectance", "wall=0.1,0.2,0.3", "--exposure", "0.5", "--source", "in.glb"});
  EXPECT_EQ(options.sky, (std::array{1.0, 2.0, 3.0}));
  ASSERT_EQ(options.reflectance.size(), 1U);
  EXPECT_EQ(options.reflectance[0].first, "wall");
  EXPECT_EQ(options.exposure, 0.5);
  EXPECT_EQ(options.source, "in.glb");
  EXPECT_TRUE(options_of({"--exposure", "auto"}).auto_exposure);
}

TEST(RelightCommand, RefusesWhatIsNoValueAndNamesTheOption) {
  EXPECT_NE(mistake_of({"--light", "lamp"}).find("--light: 'lamp' is not NAME=VALUE"), std::string::npos);
  EXPECT_NE(mistake_of({"--light", "=1"}).find("is not NAME=VALUE"), std::string::npos);
  EXPECT_NE(mistake_of({"--light", "a=1,2"}).find("has 2 numbers"), std::string::npos);
  EXPECT_NE(mistake_of({"--emissive", "a=-1"}).find("--emissive"), std::string::npos);
  EXPECT_NE(mistake_of({"--reflectance", "a=0.5,1.5,0"}).find("reflects more than 1"), std::string::npos);
  EXPECT_NE(mistake_of({"--json", "b.glb"}).find("--json"), std::string::npos);
}

}  // namespace
}  // namespace gltf_radiosity::tools
