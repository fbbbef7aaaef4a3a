#include "plugin/light_groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/plugin/gltf_builder.h"

namespace gltf_radiosity {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A square, and whatever shines on it.
struct LitSquare {
  GltfBuilder builder;
  Options options;
  std::vector<Warning> warnings;
  ImportedScene scene;

  LitSquare() { builder.add_node(builder.add_mesh(unit_square())); }

  void add_lamp(const std::string& name, const Json& more = Json::object()) {
    Json material = {{"emissiveFactor", {1.0, 1.0, 1.0}}};
    if (!name.empty()) material["name"] = name;
    material.update(more);
    PrimitiveParts square = unit_square();
    square.material = builder.add_material(material);
    builder.add_node(builder.add_mesh(square));
  }

  Result<std::vector<std::string>> group() {
    const Document document = builder.document();
    Result<ImportedScene> imported = import_scene(document, options, warnings);
    if (!imported) return imported.error();
    scene = std::move(*imported);
    return group_lights(document, options, scene, warnings);
  }

  std::vector<std::string> names() {
    const Result<std::vector<std::string>> names = group();
    EXPECT_TRUE(names) << names.error().text();
    return names ? *names : std::vector<std::string>();
  }
};

const Json kPoint = {{"type", "point"}, {"intensity", 5.0}};

TEST(LightGroups, EachLampAndLightHasItsOwnNameAndNumber) {
  LitSquare square;
  square.builder.add_light({{"type", "point"}, {"name", "bulb"}}, {{"name", "kitchen"}});
  square.builder.add_light({{"type", "point"}, {"name", "spare"}});
  square.add_lamp("sign");
  square.options.sun = Sun{45.0, 0.0, 1000.0};
  square.options.sky = {1.0, 1.0, 1.0};
  EXPECT_THAT(square.names(), ElementsAre("kitchen", "spare", "sign", "sun", "sky"));
  EXPECT_EQ(square.scene.scene.lights[1].light_group, 1U);
  EXPECT_EQ(square.scene.scene.lights[2].light_group, 3U);
  EXPECT_EQ(square.scene.scene.sky.light_group, 4U);
  std::vector<std::uint32_t> lamps;
  for (const radiosity::Surface& surface : square.scene.scene.surfaces) {
    if (surface.emission != radiosity::Rgb(0.0F)) lamps.push_back(surface.light_group);
  }
  EXPECT_THAT(lamps, ElementsAre(2U));
}

TEST(LightGroups, WhatHasNoNameIsCalledByItsPlace) {
  LitSquare square;
  square.builder.add_light(kPoint);
  square.add_lamp("");
  EXPECT_THAT(square.names(), ElementsAre("nodes[1]", "materials[0]"));
}

TEST(LightGroups, WhatHasTheSameNameSharesAGroup) {
  LitSquare square;
  square.builder.add_light(kPoint, {{"name", "lamp"}});
  square.builder.add_light(kPoint, {{"name", "lamp"}});
  square.add_lamp("lamp");
  EXPECT_THAT(square.names(), ElementsAre("lamp"));
}

TEST(LightGroups, WithoutAnyLightThereIsOne) {
  LitSquare square;
  square.options.default_sky = false;
  EXPECT_THAT(square.names(), ElementsAre("light"));
}

TEST(LightGroups, ExtrasOfTheNearestNodeAboveCount) {
  LitSquare square;
  const Json hall = {{"name", "hall"}, {"extras", {{"radiosity", {{"group", "hall lights"}}}}}};
  const std::size_t parent = square.builder.add_node(std::nullopt, hall);
  square.builder.add_light(kPoint, {{"name", "a"}});
  square.builder.add_light(kPoint, {{"name", "b"}, {"extras", {{"radiosity", {{"group", "own"}}}}}});
  Json& nodes = square.builder.json["nodes"];
  nodes[parent]["children"] = {nodes.size() - 2, nodes.size() - 1};
  square.builder.json["scenes"][0]["nodes"] = {0, parent};
  square.add_lamp("c", {{"extras", {{"radiosity", {{"group", "hall lights"}}}}}});
  EXPECT_THAT(square.names(), ElementsAre("hall lights", "own"));
}

TEST(LightGroups, ExtrasThatAreNoNameAreWarnedOf) {
  LitSquare square;
  square.builder.add_light(kPoint, {{"name", "a"}, {"extras", {{"radiosity", {{"group", 7}}}}}});
  EXPECT_THAT(square.names(), ElementsAre("a"));
  ASSERT_FALSE(square.warnings.empty());
  EXPECT_EQ(square.warnings.back().code, "bad-group");
  EXPECT_EQ(square.warnings.back().place, "nodes[1]");
}

TEST(LightGroups, TheLastPatternThatFitsWins) {
  LitSquare square;
  square.builder.add_light(kPoint, {{"name", "lamp 1"}});
  square.builder.add_light(kPoint, {{"name", "lamp 2"}, {"extras", {{"radiosity", {{"group", "extras"}}}}}});
  square.add_lamp("sign");
  square.options.groups = {{"all", "*"}, {"lamps", "lamp ?"}};
  EXPECT_THAT(square.names(), ElementsAre("lamps", "all"));
}

TEST(LightGroups, APatternThatFitsNothingIsRefusedWithWhatThereIs) {
  LitSquare square;
  square.builder.add_light(kPoint, {{"name", "kitchen"}});
  square.options.groups = {{"a", "bath"}};
  const auto names = square.group();
  ASSERT_FALSE(names);
  EXPECT_EQ(names.error().code, ErrorCode::kBadOption);
  EXPECT_THAT(names.error().text(), HasSubstr("kitchen"));
}

TEST(LightGroups, ThereAreSixteenAtMostUnlessTheyWereChosen) {
  LitSquare square;
  for (int i = 0; i < 20; ++i) square.builder.add_light(kPoint, {{"name", "lamp " + std::to_string(i)}});
  const std::vector<std::string> names = square.names();
  ASSERT_EQ(names.size(), 16U);
  EXPECT_EQ(names.back(), "other");
  EXPECT_EQ(square.scene.scene.lights[19].light_group, 15U);
  EXPECT_EQ(square.warnings.back().code, "light-groups-merged");
}

TEST(LightGroups, ThoseThatWereChosenAllHaveRoom) {
  LitSquare square;
  for (int i = 0; i < 20; ++i) {
    const std::string name = "lamp " + std::to_string(i);
    square.builder.add_light(kPoint, {{"name", name}});
    square.options.groups.emplace_back("group of " + name, name);
  }
  EXPECT_EQ(square.names().size(), 20U);
}

TEST(LightGroups, ThereIsALimitToThose) {
  LitSquare square;
  for (int i = 0; i < 65; ++i) {
    const std::string group = std::string("g").append(std::to_string(i));
    square.builder.add_light(kPoint, {{"extras", {{"radiosity", {{"group", group}}}}}});
  }
  const auto names = square.group();
  ASSERT_FALSE(names);
  EXPECT_EQ(names.error().code, ErrorCode::kBadOption);
}

}  // namespace
}  // namespace gltf_radiosity
