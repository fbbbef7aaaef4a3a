#include "plugin/export_light_groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/photometry.h"
#include "plugin/export_scene.h"
#include "plugin/group_files.h"
#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

using radiosity::kPi;
using radiosity::Rgb;
using testing::ElementsAre;

/// A white square that shows 0.25 of the group "a" and 0.5 of "b & c", at an exposure of 1.
struct GroupedSquare {
  GltfBuilder builder;
  Options options;
  std::vector<Warning> warnings;
  GroupBytes bytes;

  explicit GroupedSquare(LightGroupStorage storage) {
    options.light_groups = storage;
    options.exposure = 1.0;
  }

  /// `targets`: the primitive's own morph targets.
  Document exported(const Json& targets = Json()) {
    Json primitive = builder.primitive(unit_square());
    if (targets.is_array()) primitive["targets"] = targets;
    builder.add_node(builder.add_mesh(Json::array({primitive})));
    HandBake hand = bake_by_hand(builder, 0, Rgb(0.75F * kPi), options);
    hand.scene.light_groups = {"a", "b & c"};
    for (const float share : {0.25F, 0.5F}) {
      hand.bake.group_irradiance.emplace_back(hand.bake.irradiance.size(), Rgb(share * kPi));
    }
    const radiosity::Progress silent;
    ExportReport report = export_scene(hand.document, hand.added, hand.scene, hand.bake, options, warnings, silent);
    bytes = std::move(report.group_bytes);
    move_into(hand.document, hand.added);
    return std::move(hand.document);
  }
};

const Json& primitive_of(const Document& document) { return document.json["meshes"][0]["primitives"][0]; }

std::vector<float> first_row(const Document& document, const Json& accessor) {
  const RawAccessor raw = read_accessor(document, accessor.get<std::size_t>());
  std::vector<float> values = as_floats(raw);
  values.resize(static_cast<std::size_t>(raw.components));
  return values;
}

TEST(ExportLightGroups, MorphTargetsAddTheirLightToBlack) {
  GroupedSquare square(LightGroupStorage::kMorph);
  const Document document = square.exported();
  const Json& primitive = primitive_of(document);
  EXPECT_THAT(first_row(document, primitive["attributes"]["COLOR_0"]), ElementsAre(0.0F, 0.0F, 0.0F, 1.0F));
  ASSERT_EQ(primitive["targets"].size(), 2U);
  EXPECT_THAT(first_row(document, primitive["targets"][0]["COLOR_0"]), ElementsAre(0.25F, 0.25F, 0.25F, 0.0F));
  EXPECT_THAT(first_row(document, primitive["targets"][1]["COLOR_0"]), ElementsAre(0.5F, 0.5F, 0.5F, 0.0F));
  EXPECT_EQ(document.json["meshes"][0]["weights"], Json({1.0, 1.0}));
  EXPECT_EQ(document.json["meshes"][0]["extras"]["targetNames"], Json({"a", "b & c"}));
}

TEST(ExportLightGroups, TargetsThatMoveNothingTakeNoRoom) {
  GroupedSquare square(LightGroupStorage::kMorph);
  const Document document = square.exported();
  const Json& targets = primitive_of(document)["targets"];
  EXPECT_EQ(targets[0]["POSITION"], targets[1]["POSITION"]);
  const Json& zeros = document.json["accessors"][targets[0]["POSITION"].get<std::size_t>()];
  EXPECT_FALSE(zeros.contains("bufferView"));
  EXPECT_EQ(zeros["max"], Json({0.0, 0.0, 0.0}));
}

TEST(ExportLightGroups, WhatMovedTheMeshComesFirst) {
  GroupedSquare square(LightGroupStorage::kMorph);
  const std::vector<glm::vec3> up(4, glm::vec3(0, 1, 0));
  const Json own = {{"POSITION", square.builder.add_accessor(up)}, {"NORMAL", square.builder.add_accessor(up)}};
  const Document document = square.exported(Json::array({own}));
  const Json& targets = primitive_of(document)["targets"];
  ASSERT_EQ(targets.size(), 3U);
  EXPECT_THAT(first_row(document, targets[0]["POSITION"]), ElementsAre(0.0F, 1.0F, 0.0F));
  EXPECT_THAT(first_row(document, targets[0]["COLOR_0"]), ElementsAre(0.0F, 0.0F, 0.0F, 0.0F));
  EXPECT_THAT(first_row(document, targets[2]["NORMAL"]), ElementsAre(0.0F, 0.0F, 0.0F));
  EXPECT_THAT(first_row(document, targets[2]["COLOR_0"]), ElementsAre(0.5F, 0.5F, 0.5F, 0.0F));
  EXPECT_EQ(document.json["meshes"][0]["weights"], Json({0.0, 1.0, 1.0}));
}

TEST(ExportLightGroups, AttributesStandBesideTheWhole) {
  GroupedSquare square(LightGroupStorage::kAttributes);
  const Document document = square.exported();
  const Json& attributes = primitive_of(document)["attributes"];
  EXPECT_THAT(first_row(document, attributes["COLOR_0"]), ElementsAre(0.75F, 0.75F, 0.75F, 1.0F));
  EXPECT_THAT(first_row(document, attributes["_LIGHT_A"]), ElementsAre(0.25F, 0.25F, 0.25F));
  EXPECT_THAT(first_row(document, attributes["_LIGHT_B___C"]), ElementsAre(0.5F, 0.5F, 0.5F));
  EXPECT_EQ(document.json["asset"]["extras"]["radiosity"]["lightGroups"],
            Json::parse(R"({"storage": "attributes", "groups": [{"name": "a", "attribute": "_LIGHT_A"},
                                                                {"name": "b & c", "attribute": "_LIGHT_B___C"}]})"));
}

TEST(ExportLightGroups, IntegersAreNormalizedAndCutOff) {
  GroupedSquare square(LightGroupStorage::kAttributes);
  square.options.exposure = 3.0;
  square.options.color_type = ColorType::kU16;
  const Document document = square.exported();
  const Json& attributes = primitive_of(document)["attributes"];
  EXPECT_NEAR(first_row(document, attributes["_LIGHT_A"])[0], 0.75F, 1e-5F);
  EXPECT_EQ(first_row(document, attributes["_LIGHT_B___C"])[0], 1.0F);
}

TEST(ExportLightGroups, FilesDifferInTheBytesOfTheirColours) {
  GroupedSquare square(LightGroupStorage::kFiles);
  const Document document = square.exported();
  EXPECT_THAT(first_row(document, primitive_of(document)["attributes"]["COLOR_0"]),
              ElementsAre(0.75F, 0.75F, 0.75F, 1.0F));
  ASSERT_EQ(square.bytes.size(), 2U);
  const RawAccessor colors{ComponentType::kF32, 4, false, 4, square.bytes[1][0].bytes};
  EXPECT_THAT(as_floats(colors)[0], 0.5F);
  EXPECT_FALSE(primitive_of(document).contains("targets"));
}

TEST(GroupNames, AreToldApartWhateverTheyHold) {
  const std::vector<std::string> names = {"a b", "a.b", "A_B", "smile", "../x"};
  const auto root = Json::parse(R"({"meshes": [{"extras": {"targetNames": ["smile"]}}]})");
  const std::vector<GroupNames> groups = group_names(root, names);
  EXPECT_EQ(groups[0].attribute, "_LIGHT_A_B");
  EXPECT_EQ(groups[1].attribute, "_LIGHT_A_B_2");
  EXPECT_EQ(groups[2].attribute, "_LIGHT_A_B_3");
  EXPECT_EQ(groups[2].in_file, "A_B_3");
  EXPECT_EQ(groups[3].target, "smile light");
  EXPECT_EQ(groups[4].in_file, "___x");
}

TEST(GroupFiles, AreNamedAfterTheOutput) {
  EXPECT_EQ(path_of_group("folder.x/out.glb", "hall"), "folder.x/out.hall.glb");
  EXPECT_EQ(path_of_group("out.gltf", "hall"), "out.hall.gltf");
  EXPECT_EQ(path_of_group("out.embedded.gltf", "hall"), "out.hall.embedded.gltf");
}

}  // namespace
}  // namespace gltf_radiosity
