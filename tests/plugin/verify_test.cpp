#include "plugin/verify.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "plugin/image_decode.h"
#include "tests/plugin/bake_by_hand.h"
#include "tests/plugin/gltf_builder.h"

namespace gltf_radiosity {
namespace {

constexpr double kDark = 0.2, kBright = 0.8;

/// Two squares beside each other, each with a material of its own and, if `colors` are given, baked.
GltfBuilder two_squares(const std::vector<Json>& materials, const std::vector<double>& colors = {}) {
  GltfBuilder builder;
  for (std::size_t i = 0; i < 2; ++i) {
    PrimitiveParts square = unit_square();
    for (glm::vec3& position : square.positions) position.x += 2.0F * static_cast<float>(i);
    square.material = builder.add_material(materials[i]);
    if (!colors.empty()) {
      square.colors.assign(square.positions.size(), glm::vec4(glm::vec3(static_cast<float>(colors[i])), 1.0F));
    }
    builder.add_node(builder.add_mesh(square));
  }
  return builder;
}

Json matte(double grey) { return {{"pbrMetallicRoughness", {{"baseColorFactor", {grey, grey, grey, 1.0}}}}}; }

/// Under a sky of 1 cd/m2 each square shows its reflectance.
GltfBuilder source() { return two_squares({matte(kDark), matte(kBright)}); }

GltfBuilder baked(double first, double second) {
  const Json unlit = {{"extensions", {{"KHR_materials_unlit", Json::object()}}}};
  GltfBuilder builder = two_squares({unlit, unlit}, {first, second});
  builder.json["extensionsUsed"] = {"KHR_materials_unlit"};
  return builder;
}

class Verify : public testing::Test {
 protected:
  std::string file(const std::string& name, const GltfBuilder& builder) const {
    const Bytes glb = builder.glb();
    const std::filesystem::path path = folder / name;
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(glb.data()), static_cast<std::streamsize>(glb.size()));
    return path.string();
  }

  /// Verifies `output` against the source; expects that to work.
  VerifyReport verify(const GltfBuilder& output, VerifyOptions options = {}) const {
    options.points = 200;
    options.max_samples = 64;
    const auto report = verify_files(file("in.glb", source()), file("out.glb", output), options);
    if (report) return *report;
    ADD_FAILURE() << report.error().text();
    return {};
  }

  /// Verifies and expects an error.
  Error refusal(const std::string& input, const std::string& output, const VerifyOptions& options = {}) const {
    const auto report = verify_files(input, output, options);
    if (!report) return report.error();
    return {ErrorCode::kInternal, "", "accepted"};
  }

  TemporaryFolder folder;
};

TEST_F(Verify, ABakeThatIsRightHasNoError) {
  const VerifyReport report = verify(baked(kDark, kBright));
  EXPECT_EQ(report.points, 200U);
  EXPECT_NEAR(report.relative_rmse, 0.0, 1e-4);
  EXPECT_NEAR(report.p99, 0.0, 1e-4);
  EXPECT_NEAR(report.exposure, 1.0, 1e-4);
  EXPECT_NEAR(report.mean_luminance, 0.5, 1e-4);
  EXPECT_EQ(report.output_triangles, 4U);
  EXPECT_EQ(report.output_vertices, 8U);
  EXPECT_FALSE(report.written_exposure);
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_EQ(report.warnings[0].code, "default-sky");
}

TEST_F(Verify, AnotherExposureIsFoundAndIsNoError) {
  GltfBuilder output = baked(0.5 * kDark, 0.5 * kBright);
  output.json["asset"]["extras"]["radiosity"]["exposure"] = 0.5;
  const VerifyReport report = verify(output);
  EXPECT_NEAR(report.exposure, 0.5, 1e-4);
  EXPECT_NEAR(report.relative_rmse, 0.0, 1e-4);
  EXPECT_EQ(report.written_exposure, 0.5);
}

TEST_F(Verify, AnExposureThatTheFileGetsWrongIsReported) {
  GltfBuilder output = baked(0.5 * kDark, 0.5 * kBright);
  output.json["asset"]["extras"]["radiosity"]["exposure"] = 1.0;
  const VerifyReport report = verify(output);
  EXPECT_NEAR(report.exposure, 0.5, 1e-4);
  // With the one that is written everything shows half of what it should: errors of 0.1 and 0.4 around a mean of 0.5.
  EXPECT_NEAR(report.relative_rmse_written_exposure.value_or(0.0), std::sqrt((0.01 + 0.16) / 2.0) / 0.5, 1e-3);
  EXPECT_EQ(report.warnings.back().code, "exposure-differs");
}

TEST_F(Verify, SwappedColoursHaveAKnownError) {
  const VerifyReport report = verify(baked(kBright, kDark));
  const double k = 2.0 * kDark * kBright / (kDark * kDark + kBright * kBright);
  const double first = kBright / k - kDark, second = kDark / k - kBright;
  EXPECT_NEAR(report.exposure, k, 1e-4);
  EXPECT_NEAR(report.relative_rmse, std::sqrt((first * first + second * second) / 2.0) / 0.5, 1e-3);
}

TEST_F(Verify, TheSkyOfTheBakeIsTheOneThatCounts) {
  VerifyOptions options;
  options.bake.sky = {2.0, 2.0, 2.0};
  EXPECT_NEAR(verify(baked(kDark, kBright), options).exposure, 0.5, 1e-4);
}

TEST_F(Verify, PlacesThatTheSourceDoesNotHaveAreLeftOut) {
  GltfBuilder output = baked(kDark, kBright);
  output.json["nodes"][1]["translation"] = {0.0, 5.0, 0.0};
  const VerifyReport report = verify(output);
  EXPECT_EQ(report.points, 100U);
  EXPECT_EQ(report.unmatched_points, 100U);
  EXPECT_EQ(report.warnings.back().code, "unmatched-points");
}

TEST_F(Verify, ThePictureShowsBakeTruthAndError) {
  VerifyOptions options;
  options.image = (folder / "error.png").string();
  options.image_samples = 4;
  options.camera = {{{1.0, 5.0, 0.0}}, {{1.0, 0.0, 0.0}}, 50.0, 64, 32};
  verify(baked(kBright, kBright), options);
  const std::string png = read_text(options.image);
  const auto pixels =
      decode_image(std::span(reinterpret_cast<const std::uint8_t*>(png.data()), png.size()), options.image);
  ASSERT_TRUE(pixels);
  EXPECT_EQ(pixels->width, 3 * 64);
  EXPECT_GT(pixels->height, 32);
}

TEST_F(Verify, FilesThatCannotBeComparedAreRefused) {
  const std::string input = file("in.glb", source()), output = file("out.glb", baked(kDark, kBright));
  GltfBuilder elsewhere = baked(kDark, kBright);
  for (Json& node : elsewhere.json["nodes"]) node["translation"] = {0.0, 5.0, 0.0};

  EXPECT_EQ(refusal("no_such.glb", output).code, ErrorCode::kBadInput);
  EXPECT_EQ(refusal(input, "no_such.glb").code, ErrorCode::kBadInput);
  const Error not_baked = refusal(input, input);
  EXPECT_EQ(not_baked.code, ErrorCode::kBadInput);
  EXPECT_NE(not_baked.text().find("nothing is baked"), std::string::npos);
  EXPECT_NE(not_baked.text().find("in.glb"), std::string::npos);
  EXPECT_EQ(refusal(input, file("elsewhere.glb", elsewhere)).code, ErrorCode::kBadInput);
  EXPECT_NE(refusal(output, output).text().find("nothing to bake"), std::string::npos);
}

TEST_F(Verify, OptionsThatMakeNoSenseAreRefused) {
  const std::string input = file("in.glb", source()), output = file("out.glb", baked(kDark, kBright));
  const auto refused = [&](const auto& change) {
    VerifyOptions options;
    change(options);
    return refusal(input, output, options);
  };
  EXPECT_EQ(refused([](VerifyOptions& o) { o.points = 0; }).place, "--points");
  EXPECT_EQ(refused([](VerifyOptions& o) { o.noise = 0.0; }).place, "--noise");
  EXPECT_EQ(refused([](VerifyOptions& o) { o.max_samples = 1; }).place, "--max-samples");
  EXPECT_EQ(refused([](VerifyOptions& o) { o.bake.sky = {-1.0, 0.0, 0.0}; }).place, "--sky");
  EXPECT_EQ(refused([](VerifyOptions& o) { o.camera.width = 0; }).place, "--size");
  EXPECT_EQ(refused([](VerifyOptions& o) { o.camera.fov_degrees = 180.0; }).place, "--fov");
  EXPECT_EQ(refused([](VerifyOptions& o) { o.image = "error.jpg"; }).place, "--image");
  const std::string linked = file("scene.png", source());
  std::filesystem::remove(linked);
  std::filesystem::create_hard_link(output, linked);
  const Error replaced = refused([&](VerifyOptions& o) { o.image = linked; });
  EXPECT_EQ(replaced.place, linked);
  EXPECT_EQ(replaced.code, ErrorCode::kBadOption);
}

TEST_F(Verify, CanBeCancelled) {
  Callbacks callbacks;
  callbacks.cancelled = [] { return true; };
  const auto report = verify_files(file("in.glb", source()), file("out.glb", baked(kDark, kBright)), {}, callbacks);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kCancelled);
}

TEST_F(Verify, TheReportIsJson) {
  const auto json = nlohmann::json::parse(to_json(verify(baked(kDark, kBright))));
  EXPECT_EQ(json["points"], 200);
  EXPECT_TRUE(json["writtenExposure"].is_null());
  EXPECT_EQ(json["warnings"][0]["code"], "default-sky");
  EXPECT_EQ(json["phases"][0]["name"], "read");
}

}  // namespace
}  // namespace gltf_radiosity
