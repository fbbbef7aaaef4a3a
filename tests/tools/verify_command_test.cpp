#include "tools/verify_command.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gltf_radiosity::tools {
namespace {

using Arguments = std::vector<std::string>;

std::variant<VerifyCommand, Ending> parse_words(const Arguments& more) {
  std::vector<const char*> pointers = {"gltf-radiosity", "verify"};
  for (const std::string& argument : more) pointers.push_back(argument.c_str());
  EXPECT_TRUE(is_verify_command(pointers));
  return parse_verify_command(pointers);
}

/// Parses IN, OUT and `more`, and expects that to be a verification.
VerifyCommand parse_verify(const Arguments& more) {
  Arguments arguments = {"in.glb", "out.glb"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const auto parsed = parse_words(arguments);
  if (const auto* const ending = std::get_if<Ending>(&parsed)) {
    ADD_FAILURE() << ending->text;
    return {};
  }
  return std::get<VerifyCommand>(parsed);
}

std::string verify_mistake(const Arguments& arguments) {
  const auto parsed = parse_words(arguments);
  const auto* const ending = std::get_if<Ending>(&parsed);
  if (ending == nullptr || ending->exit_code != 2) return "accepted";
  return ending->text;
}

TEST(VerifyCommand, IsTheFirstWordAndNoOther) {
  const char* const bake[] = {"gltf-radiosity", "./verify", "out.glb"};
  const char* const last[] = {"gltf-radiosity", "in.glb", "verify"};
  const char* const none[] = {"gltf-radiosity"};
  EXPECT_FALSE(is_verify_command(bake));
  EXPECT_FALSE(is_verify_command(last));
  EXPECT_FALSE(is_verify_command(none));
}

TEST(VerifyCommand, NeedsOnlyTwoFiles) {
  const VerifyCommand command = parse_verify({});
  const VerifyOptions library;
  EXPECT_EQ(command.input, "in.glb");
  EXPECT_EQ(command.output, "out.glb");
  EXPECT_EQ(command.options.points, library.points);
  EXPECT_EQ(command.options.noise, library.noise);
  EXPECT_TRUE(command.options.image.empty());
  EXPECT_FALSE(command.max_error);
}

TEST(VerifyCommand, TakesEveryOption) {
  const VerifyCommand command = parse_verify({"--points",
                                              "500",
                                              "--noise",
                                              "0.01",
                                              "--max-samples",
                                              "256",
                                              "--seed",
                                              "7",
                                              "--threads",
                                              "3",
                                              "--sky",
                                              "1,2,3",
                                              "--sun",
                                              "40,120,5",
                                              "--no-default-sky",
                                              "--metals",
                                              "black",
                                              "--light-units",
                                              "si",
                                              "--image",
                                              "e.png",
                                              "--eye",
                                              "-1,2.5,3",
                                              "--at",
                                              "0,1,0",
                                              "--fov",
                                              "70",
                                              "--size",
                                              "320,200",
                                              "--image-samples",
                                              "16",
                                              "--max-error",
                                              "0.02",
                                              "--json",
                                              "-",
                                              "--progress",
                                              "none"});
  EXPECT_EQ(command.options.points, 500);
  EXPECT_EQ(command.options.noise, 0.01);
  EXPECT_EQ(command.options.max_samples, 256);
  EXPECT_EQ(command.options.seed, 7U);
  EXPECT_EQ(command.options.bake.threads, 3);
  EXPECT_TRUE(command.options.bake.sky);
  EXPECT_TRUE(command.options.bake.sun);
  EXPECT_FALSE(command.options.bake.default_sky);
  EXPECT_EQ(command.options.bake.metals, Metals::kBlack);
  EXPECT_EQ(command.options.bake.light_units, LightUnits::kSi);
  EXPECT_EQ(command.options.image, "e.png");
  EXPECT_EQ((*command.options.camera.eye)[0], -1.0);
  EXPECT_EQ((*command.options.camera.at)[1], 1.0);
  EXPECT_EQ(command.options.camera.fov_degrees, 70.0);
  EXPECT_EQ(command.options.camera.width, 320);
  EXPECT_EQ(command.options.camera.height, 200);
  EXPECT_EQ(command.options.image_samples, 16);
  EXPECT_EQ(command.max_error, 0.02);
  EXPECT_EQ(command.json, "-");
  EXPECT_EQ(command.progress, ProgressStyle::kNone);
}

TEST(VerifyCommand, RefusesWhatMakesNoSense) {
  EXPECT_NE(verify_mistake({"in.glb"}), "accepted");
  EXPECT_NE(verify_mistake({"in.glb", ""}), "accepted");
  const std::vector<Arguments> wrong = {{"--points", "0"},       {"--noise", "0"},      {"--noise", "nan"},
                                        {"--size", "100"},       {"--size", "8,8"},     {"--eye", "1,2"},
                                        {"--fov", "180"},        {"--max-error", "-1"}, {"--seed", "-1"},
                                        {"--max-samples", "63"}, {"--json", "out.glb"}, {"--hemicube", "16"}};
  for (const Arguments& options : wrong) {
    Arguments arguments = {"in.glb", "out.glb"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_NE(verify_mistake(arguments).find(options[0]), std::string::npos) << options[0] << " " << options[1];
  }
}

TEST(VerifyCommand, HelpAndVersionEndWell) {
  for (const char* option : {"--help", "-h", "--version"}) {
    const auto parsed = parse_words({option});
    ASSERT_TRUE(std::holds_alternative<Ending>(parsed));
    EXPECT_EQ(std::get<Ending>(parsed).exit_code, 0);
  }
}

}  // namespace
}  // namespace gltf_radiosity::tools
