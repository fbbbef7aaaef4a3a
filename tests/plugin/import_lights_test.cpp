#include "plugin/import_lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "tests/plugin/gltf_builder.h"

namespace gltf_radiosity {
namespace {

using Kind = radiosity::Light::Kind;

Document made_by(const std::string& generator) {
  GltfBuilder builder;
  builder.json["asset"]["generator"] = generator;
  builder.add_light({{"type", "point"}});
  return builder.document();
}

TEST(Lights, DefaultsAreThoseOfTheExtension) {
  const radiosity::Light light = import_light({{"type", "spot"}}, glm::dmat4(1.0), 1.0F);
  EXPECT_EQ(light.kind, Kind::kSpot);
  EXPECT_EQ(light.intensity, radiosity::Rgb(1.0F));
  EXPECT_EQ(light.range, 0.0F);
  EXPECT_EQ(light.direction, glm::vec3(0, 0, -1));
  EXPECT_FLOAT_EQ(light.inner_cone_cos, 1.0F);
  EXPECT_FLOAT_EQ(light.outer_cone_cos, std::numbers::sqrt2_v<float> / 2.0F);
}

TEST(Lights, ColorAndIntensityMultiply) {
  const Json json = {{"type", "point"}, {"color", {1.0, 0.5, 0.0}}, {"intensity", 10.0}, {"range", 4.0}};
  const radiosity::Light light = import_light(json, glm::dmat4(1.0), 0.5F);
  EXPECT_EQ(light.intensity, radiosity::Rgb(5.0F, 2.5F, 0.0F));
  EXPECT_EQ(light.range, 4.0F);
}

TEST(Lights, StandWhereTheirNodeStandsAndScaleDoesNotMatter) {
  glm::dmat4 world = glm::translate(glm::dmat4(1.0), glm::dvec3(1, 2, 3));
  world = glm::rotate(world, std::numbers::pi / 2, glm::dvec3(1, 0, 0));  // -z turns to +y
  world = glm::scale(world, glm::dvec3(10.0));
  const radiosity::Light light = import_light({{"type", "spot"}, {"intensity", 3.0}, {"range", 2.0}}, world, 1.0F);
  EXPECT_EQ(light.position, glm::vec3(1, 2, 3));
  EXPECT_NEAR(glm::distance(light.direction, glm::vec3(0, 1, 0)), 0.0F, 1e-6F);
  EXPECT_EQ(light.intensity, radiosity::Rgb(3.0F));
  EXPECT_EQ(light.range, 2.0F);
}

TEST(Lights, ConesAreKeptInOrder) {
  const Json json = {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.8}, {"outerConeAngle", 0.4}}}};
  const radiosity::Light light = import_light(json, glm::dmat4(1.0), 1.0F);
  EXPECT_FLOAT_EQ(light.outer_cone_cos, std::cos(0.4F));
  EXPECT_GE(light.inner_cone_cos, light.outer_cone_cos);
}

TEST(Lights, ACollapsedNodeKeepsADirectionOfUnitLength) {
  const radiosity::Light light =
      import_light({{"type", "directional"}}, glm::scale(glm::dmat4(1.0), glm::dvec3(0.0)), 1.0F);
  EXPECT_FLOAT_EQ(glm::length(light.direction), 1.0F);
}

TEST(Lights, BlendersUnitsAreUndoneWhenItsExporterWroteTheFile) {
  std::vector<Warning> warnings;
  EXPECT_FLOAT_EQ(light_unit_factor(made_by("Khronos glTF Blender I/O v3.6.28"), LightUnits::kAuto, warnings),
                  1.0F / 683.0F);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].code, "blender-light-units");
}

TEST(Lights, OtherExportersAreTakenAtTheirWord) {
  std::vector<Warning> warnings;
  EXPECT_EQ(light_unit_factor(made_by("glTF-Transform v4"), LightUnits::kAuto, warnings), 1.0F);
  EXPECT_EQ(light_unit_factor(made_by("Khronos glTF Blender I/O v3.6.28"), LightUnits::kSi, warnings), 1.0F);
  EXPECT_FLOAT_EQ(light_unit_factor(made_by("something"), LightUnits::kBlender, warnings), 1.0F / 683.0F);
  EXPECT_TRUE(warnings.empty());
}

TEST(Lights, AFileWithoutLightsNeedsNoWarning) {
  GltfBuilder builder;
  builder.json["asset"]["generator"] = "Khronos glTF Blender I/O v3.6.28";
  std::vector<Warning> warnings;
  light_unit_factor(builder.document(), LightUnits::kAuto, warnings);
  EXPECT_TRUE(warnings.empty());
}

TEST(Lights, TheSunShinesFromWhereItStands) {
  const auto travels = [](double elevation, double azimuth) { return import_sun({elevation, azimuth, 1.0}).direction; };
  EXPECT_NEAR(glm::distance(travels(90, 0), glm::vec3(0, -1, 0)), 0.0F, 1e-6F);
  EXPECT_NEAR(glm::distance(travels(0, 0), glm::vec3(0, 0, -1)), 0.0F, 1e-6F);
  EXPECT_NEAR(glm::distance(travels(0, 90), glm::vec3(-1, 0, 0)), 0.0F, 1e-6F);
  EXPECT_EQ(import_sun({30, 0, 100000.0}).intensity, radiosity::Rgb(100000.0F));
  EXPECT_EQ(import_sun({30, 0, 1.0}).kind, Kind::kDirectional);
}

}  // namespace
}  // namespace gltf_radiosity
