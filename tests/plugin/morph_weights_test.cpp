#include "plugin/morph_weights.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

/// A square with one morph target at a node, whose weight is animated at two keys.
struct MorphedSquare {
  GltfBuilder builder;
  std::vector<Warning> warnings;

  MorphedSquare() {
    Json primitive = builder.primitive(unit_square());
    primitive["targets"] = {{{"POSITION", builder.add_accessor(std::vector<glm::vec3>(4, glm::vec3(0, 1, 0)))}}};
    builder.add_node(builder.add_mesh(Json::array({primitive})));
  }

  std::size_t add_floats(const std::vector<float>& values) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(values.data());
    return builder.add_accessor(std::span(bytes, values.size() * sizeof(float)), 5126, "SCALAR", values.size());
  }

  void animate(const Json& target, const std::vector<float>& output, const char* interpolation = "LINEAR") {
    const std::size_t input = add_floats({0.0F, 1.0F}), values = add_floats(output);
    builder.json["animations"].push_back(
        {{"channels", {{{"sampler", 0}, {"target", target}}}},
         {"samplers", {{{"input", input}, {"output", values}, {"interpolation", interpolation}}}}});
  }

  /// With two targets more.
  Document extended() {
    Document document = builder.document();
    BufferBuilder added;
    add_morph_weights(document, added, 0, {1, {"kitchen", "hall"}}, warnings);
    move_into(document, added);
    return document;
  }
};

std::vector<float> output_of(const Document& document) {
  const Json& sampler = document.json["animations"][0]["samplers"][0];
  return as_floats(read_accessor(document, sampler["output"].get<std::size_t>()));
}

TEST(MorphWeights, NewTargetsAreNamedAndShown) {
  MorphedSquare square;
  square.builder.json["meshes"][0]["weights"] = {0.5};
  const Json mesh = square.extended().json["meshes"][0];
  EXPECT_EQ(mesh["weights"], Json({0.5, 1.0, 1.0}));
  EXPECT_EQ(mesh["extras"]["targetNames"], Json({"target 0", "kitchen", "hall"}));
}

TEST(MorphWeights, NamesAndExtrasStay) {
  MorphedSquare square;
  square.builder.json["meshes"][0]["extras"] = {{"targetNames", {"smile"}}, {"more", 1}};
  EXPECT_EQ(square.extended().json["meshes"][0]["extras"],
            Json::parse(R"({"targetNames": ["smile", "kitchen", "hall"], "more": 1})"));
}

TEST(MorphWeights, NodesHaveTheirOwn) {
  MorphedSquare square;
  square.builder.json["nodes"][0]["weights"] = {0.25};
  EXPECT_EQ(square.extended().json["nodes"][0]["weights"], Json({0.25, 1.0, 1.0}));
}

TEST(MorphWeights, AnimationsFollow) {
  MorphedSquare square;
  square.animate({{"node", 0}, {"path", "weights"}}, {0.0F, 0.5F});
  EXPECT_EQ(output_of(square.extended()), (std::vector<float>{0.0F, 1.0F, 1.0F, 0.5F, 1.0F, 1.0F}));
  EXPECT_TRUE(square.warnings.empty());
}

TEST(MorphWeights, TangentsOfSplinesAreFlat) {
  MorphedSquare square;
  square.animate({{"node", 0}, {"path", "weights"}}, {9.0F, 0.0F, 8.0F, 7.0F, 0.5F, 6.0F}, "CUBICSPLINE");
  EXPECT_EQ(output_of(square.extended()),
            (std::vector<float>{9, 0, 0, 0, 1, 1, 8, 0, 0, 7, 0, 0, 0.5F, 1, 1, 6, 0, 0}));
}

TEST(MorphWeights, PointersToWeightsAreFollowed) {
  for (const char* pointer : {"/nodes/0/weights", "/meshes/0/weights"}) {
    MorphedSquare square;
    square.animate({{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}},
                   {0.0F, 0.5F});
    EXPECT_EQ(output_of(square.extended()).size(), 6U) << pointer;
  }
}

TEST(MorphWeights, OtherAnimationsStay) {
  MorphedSquare square;
  square.animate({{"node", 0}, {"path", "translation"}}, {0, 0, 0, 1, 1, 1});
  EXPECT_EQ(output_of(square.extended()).size(), 6U);
  EXPECT_TRUE(square.warnings.empty());
}

TEST(MorphWeights, WhatMakesNoSenseIsLeftWithAWarning) {
  MorphedSquare square;
  square.animate({{"node", 0}, {"path", "weights"}}, {0.0F, 0.5F, 0.7F});
  EXPECT_EQ(output_of(square.extended()).size(), 3U);
  ASSERT_EQ(square.warnings.size(), 1U);
  EXPECT_EQ(square.warnings[0].code, "animation-left");
  EXPECT_EQ(square.warnings[0].place, "animations[0]");
}

TEST(MorphWeights, BrokenAnimationsDoNoHarm) {
  for (const char* text : {"7", R"([{"channels": [{"sampler": 9, "target": {"node": 0, "path": "weights"}}]}])",
                           R"([{"channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}],
                                "samplers": [{"input": 0, "output": 12345}]}])",
                           R"([{"channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}],
                                "samplers": 3}])",
                           R"([{"channels": [7, {"target": 1}, {"sampler": -1}]}])"}) {
    MorphedSquare square;
    square.builder.json["animations"] = Json::parse(text);
    EXPECT_EQ(square.extended().json["animations"], Json::parse(text));
  }
}

}  // namespace
}  // namespace gltf_radiosity
