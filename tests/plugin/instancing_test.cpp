#include "plugin/instancing.h"

#include <gtest/gtest.h>

#include "tests/plugin/gltf_builder.h"

namespace gltf_radiosity {
namespace {

constexpr const char* kInstances = "EXT_mesh_gpu_instancing";

/// Two copies of a square on a node called "tiles", 10 m and 20 m along x; `extra` attributes are merged in.
GltfBuilder two_tiles(const Json& more_attributes = Json::object()) {
  GltfBuilder builder;
  Json node = {{"name", "tiles"}, {"translation", {0, 1, 0}}};
  node["extensions"][kInstances]["attributes"] = {
      {"TRANSLATION", builder.add_accessor(std::vector<glm::vec3>{{10, 0, 0}, {20, 0, 0}})}};
  node["extensions"][kInstances]["attributes"].update(more_attributes);
  builder.add_node(builder.add_mesh(unit_square()), node);
  builder.json["extensionsUsed"] = {kInstances};
  return builder;
}

std::string refusal(const GltfBuilder& builder) {
  const auto document = read_document(builder.glb(), {});
  if (!document) return document.error().text();
  std::vector<Warning> warnings;
  const auto scene = import_scene(*document, {}, warnings);
  return scene ? "fine" : scene.error().text();
}

ImportedScene imported_instances(const Document& document) {
  std::vector<Warning> warnings;
  auto scene = import_scene(document, {}, warnings);
  EXPECT_TRUE(scene) << scene.error().text();
  return std::move(*scene);
}

TEST(Instancing, EachCopyStandsInItsPlace) {
  const Document document = two_tiles().document();
  const ImportedScene scene = imported_instances(document);
  ASSERT_EQ(scene.instances.size(), 2U);
  EXPECT_EQ(scene.scene.positions[0], glm::vec3(10, 1, 0));
  EXPECT_EQ(scene.scene.positions[4], glm::vec3(20, 1, 0));
  EXPECT_EQ(scene.instances[1].copy, 1U);
}

TEST(Instancing, CopiesAreTurnedStretchedAndMirrored) {
  GltfBuilder builder = two_tiles();
  Json& attributes = builder.json["nodes"][0]["extensions"][kInstances]["attributes"];
  attributes["SCALE"] = builder.add_accessor(std::vector<glm::vec3>{{2, 1, 1}, {-1, 1, 1}});
  // A quarter turn about y in 16 bits, not quite of unit length, and no turn.
  const std::vector<std::int16_t> turns = {0, 23170, 0, 23170, 0, 0, 0, 32767};
  Json& again = builder.json["nodes"][0]["extensions"][kInstances]["attributes"];
  again["ROTATION"] =
      builder.add_accessor({reinterpret_cast<const std::uint8_t*>(turns.data()), 16}, 5122, "VEC4", 2, true);
  const Document document = builder.document();
  const ImportedScene scene = imported_instances(document);
  const glm::vec3 far = scene.scene.positions[3];  // (1, 0, 0) in the mesh
  EXPECT_NEAR(far.x, 10.0F, 1e-5F);
  EXPECT_NEAR(far.z, -2.0F, 1e-5F);
  EXPECT_EQ(scene.scene.positions[7], glm::vec3(19, 1, 0));
  EXPECT_FALSE(scene.instances[0].mirrored);
  EXPECT_TRUE(scene.instances[1].mirrored);
}

TEST(Instancing, BakedCopiesBecomeChildrenOfTheirNode) {
  GltfBuilder builder = two_tiles();
  const std::vector<std::uint8_t> ids = {0, 0, 0, 7, 0, 0, 0, 9};  // little endian
  const std::size_t id = builder.add_accessor(ids, 5125, "SCALAR", 2);
  builder.json["nodes"][0]["extensions"][kInstances]["attributes"]["_ID"] = id;
  builder.json["nodes"][0]["extras"] = {{"kept", true}};
  builder.add_node(std::nullopt, {{"name", "child"}}, 0);
  Document document = builder.document();
  const ImportedScene scene = imported_instances(document);
  EXPECT_EQ(expand_copies(document, scene.instances), (std::vector<std::size_t>{2, 3}));
  const Json& nodes = document.json["nodes"];
  EXPECT_EQ(nodes[0], Json::parse(R"({"name": "tiles", "translation": [0, 1, 0], "extras": {"kept": true},
                                      "children": [1, 2, 3]})"));
  EXPECT_EQ(nodes[2], Json::parse(R"({"name": "tiles[0]", "mesh": 0, "translation": [10.0, 0.0, 0.0],
                                      "extras": {"_ID": 117440512.0}})"));
  EXPECT_EQ(nodes[3]["name"], "tiles[1]");
  EXPECT_FALSE(document.json.contains("extensionsUsed"));
}

TEST(Instancing, CopiesThatAreNotBakedStayInstances) {
  GltfBuilder builder = two_tiles();
  builder.json["materials"] = Json::array({Json::object()});
  builder.json["materials"][0]["extensions"]["KHR_materials_unlit"] = Json::object();
  builder.json["meshes"][0]["primitives"][0]["material"] = 0;
  builder.add_node(builder.add_mesh(unit_square()));
  Document document = builder.document();
  const Json before = document.json;
  const ImportedScene scene = imported_instances(document);
  EXPECT_EQ(scene.instances.size(), 3U) << "they cast shadows all the same";
  EXPECT_EQ(expand_copies(document, scene.instances), (std::vector<std::size_t>{0, 0, 1}));
  EXPECT_EQ(document.json, before);
}

TEST(Instancing, AnimatedMorphWeightsFollowTheCopies) {
  GltfBuilder builder = two_tiles();
  builder.json["nodes"][0]["weights"] = {0.25};
  builder.json["animations"] = Json::parse(R"([
    {"channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}},
                  {"sampler": 1, "target": {"node": 0, "path": "translation"}},
                  {"sampler": 2, "target": {"path": "pointer",
                   "extensions": {"KHR_animation_pointer": {"pointer": "/nodes/0/weights/0"}}}}]},
    {"channels": "nonsense"}])");
  Document document = builder.document();
  const ImportedScene scene = imported_instances(document);
  static_cast<void>(expand_copies(document, scene.instances));
  EXPECT_FALSE(document.json["nodes"][0].contains("weights"));
  EXPECT_EQ(document.json["nodes"][1]["weights"], Json({0.25}));
  const Json& channels = document.json["animations"][0]["channels"];
  ASSERT_EQ(channels.size(), 5U);
  EXPECT_EQ(channels[0]["target"]["node"], 1);
  EXPECT_EQ(channels[1]["target"]["node"], 0) << "the whole node moves";
  EXPECT_EQ(channels[2]["target"]["extensions"]["KHR_animation_pointer"]["pointer"], "/nodes/1/weights/0");
  EXPECT_EQ(channels[3]["target"]["node"], 2);
  EXPECT_EQ(channels[4]["target"]["extensions"]["KHR_animation_pointer"]["pointer"], "/nodes/2/weights/0");
}

TEST(Instancing, WhatMakesNoSenseIsRefused) {
  EXPECT_EQ(refusal(two_tiles({{"SCALE", 99}})), "nodes[0]: \"SCALE\" refers to accessors[99], but there are 5");
  GltfBuilder builder = two_tiles();
  const std::size_t three = builder.add_accessor(std::vector<glm::vec3>(3));
  builder.json["nodes"][0]["extensions"][kInstances]["attributes"]["SCALE"] = three;
  EXPECT_EQ(refusal(builder), "nodes[0]: the attributes of its instances have different counts");
  builder.json["nodes"][0]["extensions"][kInstances]["attributes"] = {{"ROTATION", three}};
  EXPECT_EQ(refusal(builder), "nodes[0]: ROTATION of its instances cannot be VEC3");
  builder = two_tiles();
  const std::size_t moved = builder.json["nodes"][0]["extensions"][kInstances]["attributes"]["TRANSLATION"];
  builder.json["accessors"][moved].erase("bufferView");
  EXPECT_EQ(refusal(builder), "nodes[0]: TRANSLATION of its instances has no data");
  builder = two_tiles();
  builder.json["skins"] = Json::parse(R"([{"joints": [0]}])");
  builder.json["nodes"][0]["skin"] = 0;
  EXPECT_EQ(refusal(builder), "nodes[0]: EXT_mesh_gpu_instancing does not say where skinned copies stand");
}

}  // namespace
}  // namespace gltf_radiosity
