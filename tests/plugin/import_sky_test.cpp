#include "plugin/import_sky.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <numbers>

#include "plugin/check_document.h"
#include "tests/plugin/gltf_builder.h"
#include "tests/plugin/hdr_file.h"

namespace gltf_radiosity {
namespace {

using radiosity::luminance_towards;
using radiosity::Rgb;
using radiosity::Sky;
using testing::HasSubstr;

constexpr float kHalf = 0.70710678F;

/// The sky, what was warned of, and why there is none.
struct ImportedSky {
  std::optional<Sky> sky;
  std::vector<Warning> warnings;
  std::string fault;
  ErrorCode code = ErrorCode::kInternal;

  bool warned(const std::string& code_wanted) const {
    return std::any_of(warnings.begin(), warnings.end(), [&](const Warning& w) { return w.code == code_wanted; });
  }
};

ImportedSky import_light(const GltfBuilder& builder, const Options& options = {}) {
  ImportedSky result;
  auto sky = import_sky(builder.document(), options, result.warnings);
  if (sky) {
    result.sky = std::move(*sky);
  } else {
    result.fault = sky.error().text();
    result.code = sky.error().code;
  }
  return result;
}

/// The index of a new image of one colour, `size` texels wide.
std::size_t add_face(GltfBuilder& builder, int size, const std::vector<std::uint8_t>& rgba) {
  std::vector<std::uint8_t> texels(static_cast<std::size_t>(size) * static_cast<std::size_t>(size) * 4);
  for (std::size_t k = 0; k < texels.size(); ++k) texels[k] = rgba[k % 4];
  const std::size_t texture = builder.add_texture(size, size, texels);
  return builder.json["textures"][texture]["source"].get<std::size_t>();
}

/// A document with an image-based light: faces of 2 x 2 texels whose alpha of 51 makes 255 stand for 5 cd/m2, each
/// with a band of its own: +x red, +y green, +z blue, and half as much, a quarter on each, on the other sides.
GltfBuilder with_light(const Json& more = Json::object()) {
  GltfBuilder builder;
  Json faces = Json::array();
  for (int k = 0; k < 6; ++k) {
    std::vector<std::uint8_t> rgba = {0, 0, 0, 51};
    rgba[static_cast<std::size_t>(k / 2)] = k % 2 == 0 ? 255 : 188;
    faces.push_back(add_face(builder, 2, rgba));
  }
  Json light = {{"specularImages", Json::array({faces})}, {"specularImageSize", 2}};
  light.update(more);
  builder.json["extensions"]["EXT_lights_image_based"]["lights"] = Json::array({light});
  builder.json["scenes"] = Json::array({{{"nodes", Json::array()}}});
  builder.json["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
  return builder;
}

Json& light_of(GltfBuilder& builder) { return builder.json["extensions"]["EXT_lights_image_based"]["lights"][0]; }

/// Coefficients of irradiance pi * (1, 2, 3) from everywhere.
Json even_coefficients() {
  Json coefficients = Json::array();
  const double first = std::numbers::pi * std::sqrt(4.0 * std::numbers::pi);
  for (int k = 0; k < 9; ++k) {
    coefficients.push_back(k == 0 ? Json::array({first, 2.0 * first, 3.0 * first}) : Json::array({0, 0, 0}));
  }
  return coefficients;
}

void expect_near(const Rgb& actual, const Rgb& expected, float tolerance) {
  EXPECT_LT(glm::distance(actual, expected), tolerance) << actual.x << ' ' << actual.y << ' ' << actual.z;
}

std::string temporary_hdr(const Bytes& bytes) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const std::string file = testing::TempDir() + test->name() + ".hdr";
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return file;
}

TEST(ImportSky, IsNothingUnlessThereIsOne) { EXPECT_FALSE(import_light(GltfBuilder()).sky); }

TEST(ImportSky, TakesALuminance) {
  Options options;
  options.sky = {0.1, 0.2, 0.3};
  const ImportedSky result = import_light(GltfBuilder(), options);
  ASSERT_TRUE(result.sky);
  EXPECT_FALSE(result.sky->has_map());
  EXPECT_EQ(result.sky->luminance, Rgb(0.1F, 0.2F, 0.3F));
}

TEST(ImportSky, ReadsAnHdrImageWithPlusXInItsMiddle) {
  Options options;
  std::vector<Rgb> texels(8, Rgb(1.0F));
  texels[2] = Rgb(4.0F);  // upper row, right of the middle: between +x and +z
  options.sky_file = temporary_hdr(encode_hdr(4, 2, texels));
  ImportedSky result = import_light(GltfBuilder(), options);
  ASSERT_TRUE(result.sky) << result.fault;
  EXPECT_EQ(luminance_towards(*result.sky, {0.5F, kHalf, 0.5F}), Rgb(4.0F));
  EXPECT_EQ(luminance_towards(*result.sky, {0.5F, -kHalf, 0.5F}), Rgb(1.0F));
  EXPECT_EQ(luminance_towards(*result.sky, {0.5F, kHalf, -0.5F}), Rgb(1.0F));

  // A quarter turn towards larger azimuth, from +z to +x.
  options.sky_rotation_degrees = 90.0;
  result = import_light(GltfBuilder(), options);
  EXPECT_EQ(luminance_towards(*result.sky, {0.5F, kHalf, -0.5F}), Rgb(4.0F));
  EXPECT_EQ(luminance_towards(*result.sky, {0.5F, kHalf, 0.5F}), Rgb(1.0F));
}

TEST(ImportSky, NamesAFileThatCannotBeUsed) {
  Options options;
  options.sky_file = testing::TempDir() + "nowhere.hdr";
  ImportedSky result = import_light(GltfBuilder(), options);
  EXPECT_EQ(result.code, ErrorCode::kBadInput);
  EXPECT_THAT(result.fault, HasSubstr("nowhere.hdr: the file does not exist"));
  options.sky_file = temporary_hdr({'G', 'I', 'F'});
  result = import_light(GltfBuilder(), options);
  EXPECT_EQ(result.code, ErrorCode::kBadInput);
  EXPECT_THAT(result.fault, HasSubstr(".hdr: is not a Radiance HDR image"));
}

TEST(ImportSky, ReadsTheCubeMapOfTheFile) {
  const ImportedSky result = import_light(with_light({{"intensity", 2.0}}));
  ASSERT_TRUE(result.sky) << result.fault;
  EXPECT_TRUE(result.warnings.empty());
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 along(0.1F);
    along[axis] = 1.0F;
    Rgb expected(0.0F);
    expected[axis] = 10.0F;
    expect_near(luminance_towards(*result.sky, glm::normalize(along)), expected, 1e-4F);
    expect_near(luminance_towards(*result.sky, -glm::normalize(along)), 0.5029F * expected, 1e-2F);
  }
}

TEST(ImportSky, FacesAreSeenFromInside) {
  // The right half of each side face and the lower half of the top are lit.
  std::array<CubeFace, 6> faces;
  for (std::size_t k = 0; k < 6; ++k) {
    const bool top = k == 2 || k == 3;
    faces[k] = {2, {Rgb(0.0F), Rgb(top ? 0.0F : 1.0F), Rgb(top ? 1.0F : 0.0F), Rgb(1.0F)}};
  }
  const Sky sky = sky_from_cube(faces);
  EXPECT_EQ(sky.width, 8);
  const auto lit = [&](const glm::vec3& d) { return luminance_towards(sky, glm::normalize(d)).x; };
  EXPECT_EQ(lit({1, 0.1F, 0.5F}), 1.0F) << "+z is to the right of +x";
  EXPECT_EQ(lit({1, 0.1F, -0.5F}), 0.0F);
  EXPECT_EQ(lit({-1, 0.1F, -0.5F}), 1.0F);
  EXPECT_EQ(lit({-0.5F, 0.1F, 1}), 1.0F);
  EXPECT_EQ(lit({0.5F, 0.1F, -1}), 1.0F);
  EXPECT_EQ(lit({0.2F, 1, 0.5F}), 1.0F) << "+z is below the middle of +y";
  EXPECT_EQ(lit({0.2F, 1, -0.5F}), 0.0F);
  EXPECT_EQ(lit({0.2F, -1, -0.5F}), 1.0F) << "-z is below the middle of -y";
}

TEST(ImportSky, TheFilesRotationTurnsItsSky) {
  // A quarter turn about y takes +z to +x.
  const ImportedSky turned = import_light(with_light({{"rotation", {0.0, kHalf, 0.0, kHalf}}}));
  ASSERT_TRUE(turned.sky) << turned.fault;
  expect_near(luminance_towards(*turned.sky, glm::normalize(glm::vec3(1, 0.1F, 0.1F))), {0, 0, 5}, 1e-4F);
  // A quarter turn about x takes +y to +z.
  const ImportedSky tipped = import_light(with_light({{"rotation", {kHalf, 0.0, 0.0, kHalf}}}));
  expect_near(luminance_towards(*tipped.sky, glm::normalize(glm::vec3(0.1F, 0.1F, 1))), {0, 5, 0}, 1e-4F);
}

TEST(ImportSky, CoefficientsStandInForImagesThatCannotBeUsed) {
  GltfBuilder builder = with_light({{"irradianceCoefficients", even_coefficients()}, {"intensity", 0.5}});
  builder.json["images"][3] = {{"uri", "data:image/png;base64,AAAA"}};
  const ImportedSky result = import_light(builder);
  ASSERT_TRUE(result.sky) << result.fault;
  EXPECT_TRUE(result.warned("image-based-light-images"));
  EXPECT_THAT(result.warnings[0].message, HasSubstr("images[3]"));
  for (const Rgb& texel : result.sky->map) expect_near(texel, {0.5F, 1.0F, 1.5F}, 1e-4F);

  light_of(builder).erase("irradianceCoefficients");
  EXPECT_THAT(import_light(builder).fault, HasSubstr("images[3]"));
}

TEST(ImportSky, CoefficientsGiveTheIrradianceTheyStandFor) {
  // Luminance 1 + y / 2 brings pi + pi/3 to an upward surface; its harmonic of irradiance is that of y.
  std::array<Rgb, 9> coefficients{};
  coefficients[0] = Rgb(static_cast<float>(std::numbers::pi * std::sqrt(4.0 * std::numbers::pi)));
  coefficients[1] = Rgb(static_cast<float>(2.0 * std::numbers::pi / 3.0 * 0.5 / 0.488603));
  const Sky sky = sky_from_coefficients(coefficients);
  for (const glm::vec3 d : {glm::vec3(0, 1, 0), glm::vec3(1, 0, 0), glm::vec3(0, -0.6F, 0.8F)}) {
    EXPECT_NEAR(luminance_towards(sky, d).x, 1.0F + 0.5F * d.y, 0.02F);
  }
  coefficients[1] *= 10.0F;
  EXPECT_EQ(luminance_towards(sky_from_coefficients(coefficients), {0, -1, 0}), Rgb(0.0F)) << "never negative";
}

TEST(ImportSky, OptionsReplaceTheFilesSkyAndSaySo) {
  Options options;
  options.sky = {1.0, 1.0, 1.0};
  const ImportedSky result = import_light(with_light(), options);
  EXPECT_FALSE(result.sky->has_map());
  EXPECT_TRUE(result.warned("image-based-light-replaced"));
}

TEST(ImportSky, ALightThatIsOffIsNone) { EXPECT_FALSE(import_light(with_light({{"intensity", 0.0}})).sky); }

TEST(ImportSky, TakesTheLightOfTheSceneThatIsBaked) {
  GltfBuilder builder = with_light();
  builder.json["scenes"].push_back({{"nodes", Json::array()}});
  builder.json["scene"] = 1;
  EXPECT_FALSE(import_light(builder).sky);
}

TEST(CheckEnvironment, NamesWhatIsWrong) {
  const auto fault_after = [](const auto& change) {
    GltfBuilder builder = with_light({{"irradianceCoefficients", even_coefficients()}});
    change(builder.json, light_of(builder));
    const auto checked = check_environment(builder.document().json);
    return checked ? "nothing is wrong" : checked.error().text();
  };
  const std::string place = "extensions.EXT_lights_image_based.lights[0]: ";
  EXPECT_EQ(fault_after([](Json&, Json&) {}), "nothing is wrong");
  EXPECT_EQ(fault_after([](Json&, Json& light) { light = 3; }), place + "is not an object");
  EXPECT_THAT(fault_after([](Json&, Json& light) { light["intensity"] = "x"; }), HasSubstr("intensity"));
  EXPECT_THAT(fault_after([](Json&, Json& light) { light["rotation"] = {0, 0, 1}; }), HasSubstr("rotation"));
  EXPECT_THAT(fault_after([](Json&, Json& light) { light["specularImages"][0][5] = 99; }), HasSubstr("specularImages"));
  EXPECT_THAT(fault_after([](Json&, Json& light) { light["specularImages"][0].erase(0); }),
              HasSubstr("specularImages"));
  EXPECT_THAT(fault_after([](Json&, Json& light) { light["irradianceCoefficients"][2] = {1, 2}; }), HasSubstr("nine"));
  EXPECT_THAT(fault_after([](Json&, Json& light) { light = Json::object(); }), HasSubstr("has neither"));
  EXPECT_THAT(
      fault_after([](Json& root, Json&) { root["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 1; }),
      HasSubstr("scenes[0]: refers to image-based light 1, but there are 1"));
}

}  // namespace
}  // namespace gltf_radiosity
