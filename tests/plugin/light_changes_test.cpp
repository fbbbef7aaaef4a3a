#include "plugin/light_changes.h"

#include <gtest/gtest.h>

#include <limits>

namespace gltf_radiosity {
namespace {

using radiosity::Rgb;

/// Two bulbs of one light, a sun, a lamp and the sky; a wall, the lamp's material and glass.
TransportDescription room() {
  TransportDescription room;
  LightSource bulb{LightSource::Kind::kLight, "bulb", {"left", "right"}, 0, Rgb(4, 2, 0)};
  bulb.color = {1, 0.5F, 0};
  room.sources = {bulb,
                  {LightSource::Kind::kSun, "sun", {}, std::nullopt, Rgb(100)},
                  {LightSource::Kind::kMaterial, "lamp", {}, 1, Rgb(2, 3, 4)},
                  {LightSource::Kind::kSky, "sky", {}, std::nullopt, Rgb(1)}};
  room.materials = {{"wall", 0, Rgb(0.5F), std::nullopt, false},
                    {"lamp", 1, Rgb(0.8F), 2, false},
                    {"glass", 2, Rgb(1), std::nullopt, true}};
  return room;
}

ChangedLight changed(const RelightOptions& options) {
  const Result<ChangedLight> result = changed_light(room(), options);
  EXPECT_TRUE(result) << result.error().text();
  return result ? *result : ChangedLight{};
}

std::string refusal(const RelightOptions& options) {
  const Result<ChangedLight> result = changed_light(room(), options);
  EXPECT_FALSE(result);
  EXPECT_TRUE(result || result.error().code == ErrorCode::kBadOption);
  return result ? "" : result.error().text();
}

TEST(LightChanges, AreNoneUnlessAskedFor) {
  const ChangedLight same = changed({});
  EXPECT_EQ(dimmers_of(room(), same), (std::vector<Rgb>{Rgb(1, 1, 0), Rgb(1), Rgb(1), Rgb(1)}));
  EXPECT_TRUE(same.sources.empty());
  EXPECT_TRUE(same.materials.empty());
}

TEST(LightChanges, KeepTheColourOrTheIntensityThatIsNotGiven) {
  RelightOptions options;
  options.lights = {{"bulb", {.color = std::nullopt, .intensity = 10.0}}};
  EXPECT_EQ(changed(options).strength[0], Rgb(10, 5, 0));
  options.lights = {{"bulb", {.color = {{0.0, 0.25, 1.0}}, .intensity = std::nullopt}}};
  EXPECT_EQ(changed(options).strength[0], Rgb(0, 1, 4));
}

TEST(LightChanges, FindALightByItsNodesAndTheSunByItsName) {
  RelightOptions options;
  options.lights = {{"right", {.color = {{0.0, 0.0, 1.0}}, .intensity = 8.0}},
                    {"sun", {.color = std::nullopt, .intensity = 50.0}}};
  const ChangedLight light = changed(options);
  EXPECT_EQ(light.sources, (std::vector<std::size_t>{0, 1}));
  // The bulb had no blue: there it was as bright as its brightest band, and dimmed.
  EXPECT_EQ(dimmers_of(room(), light)[0], Rgb(0, 0, 2));
  EXPECT_EQ(dimmers_of(room(), light)[1], Rgb(0.5F));
}

TEST(LightChanges, ScaleOrReplaceWhatAMaterialEmits) {
  RelightOptions options;
  options.emissive = {{"lamp", {.luminance = std::nullopt, .scale = 2.0}}};
  EXPECT_EQ(changed(options).strength[2], Rgb(4, 6, 8));
  options.emissive = {{"lamp", {.luminance = {{1.0, 0.0, 2.0}}, .scale = std::nullopt}}};
  EXPECT_EQ(changed(options).strength[2], Rgb(1, 0, 2));
}

TEST(LightChanges, NameWhatThereIsWhereANameLeadsNowhere) {
  RelightOptions options;
  options.lights = {{"lamp", {.color = std::nullopt, .intensity = 1.0}}};
  EXPECT_EQ(refusal(options), "--light: no light is called 'lamp'; there are: bulb, sun");
  options = {};
  options.emissive = {{"wall", {.luminance = std::nullopt, .scale = 2.0}}};
  EXPECT_EQ(refusal(options), "--emissive: no material that emits light is called 'wall'; there are: lamp");
  options = {};
  options.reflectance = {{"floor", {0.5, 0.5, 0.5}}};
  EXPECT_EQ(refusal(options), "--reflectance: no material is called 'floor'; there are: glass, lamp, wall");
}

TEST(LightChanges, RefuseWhatNoLightCanBe) {
  RelightOptions options;
  options.lights = {{"sun", {.color = std::nullopt, .intensity = -1.0}}};
  EXPECT_NE(refusal(options).find("is negative or not finite"), std::string::npos);
  options = {};
  options.sky = {{std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}};
  EXPECT_NE(refusal(options).find("--sky"), std::string::npos);
  options = {};
  options.reflectance = {{"wall", {0.5, 1.5, 0.5}}};
  EXPECT_NE(refusal(options).find("must lie in [0,1]"), std::string::npos);
  options.reflectance = {{"glass", {0.5, 0.5, 0.5}}};
  EXPECT_NE(refusal(options).find("lets light through"), std::string::npos);
}

TEST(LightChanges, ReachTheLightsOfTheDocumentAndMaterialsThatAreLit) {
  Json root = Json::parse(R"({
    "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 4, "color": [1, 0.5, 0]}]}},
    "materials": [{"name": "wall", "extensions": {"KHR_materials_unlit": {}}}, {"name": "lamp", "emissiveFactor": [1, 1, 1]}]
  })");
  RelightOptions options;
  options.lights = {{"bulb", {.color = {{0.5, 0.25, 1.0}}, .intensity = 8.0}}};
  options.emissive = {{"lamp", {.luminance = {{4.0, 2.0, 1.0}}, .scale = std::nullopt}}};
  options.reflectance = {{"wall", {0.1, 0.2, 0.3}}, {"lamp", {0.25, 0.5, 0.75}}};
  change_document(room(), changed(options), root);
  const Json& light = root["extensions"]["KHR_lights_punctual"]["lights"][0];
  EXPECT_EQ(light["intensity"], 8.0);
  EXPECT_EQ(light["color"], Json::parse("[0.5, 0.25, 1.0]"));
  EXPECT_EQ(root["materials"][0].size(), 2U);
  const Json& lamp = root["materials"][1];
  EXPECT_EQ(lamp["emissiveFactor"], Json::parse("[1.0, 0.5, 0.25]"));
  EXPECT_EQ(lamp["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"], 4.0);
  EXPECT_EQ(lamp["pbrMetallicRoughness"]["baseColorFactor"], Json::parse("[0.25, 0.5, 0.75, 1.0]"));
  EXPECT_EQ(root["extensionsUsed"], Json::parse(R"(["KHR_materials_emissive_strength"])"));
}

}  // namespace
}  // namespace gltf_radiosity
