#include "plugin/select_nodes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "tests/plugin/gltf_builder.h"

namespace gltf_radiosity {
namespace {

using testing::ElementsAre;

/// house { wall, lamp { bulb } }, garden { tree 1 }
GltfBuilder village() {
  GltfBuilder builder;
  const auto node = [&](const char* name, std::optional<std::size_t> parent = std::nullopt) {
    return builder.add_node(std::nullopt, {{"name", name}}, parent);
  };
  const std::size_t house = node("house");
  node("wall", house);
  node("bulb", node("lamp", house));
  node("tree 1", node("garden"));
  return builder;
}

constexpr int kHouse = 0, kLamp = 2;

struct Selection {
  std::vector<std::string> select, exclude;
};

std::vector<std::uint8_t> receiving(const GltfBuilder& builder, const Selection& selection,
                                    std::vector<Warning>* warnings = nullptr) {
  const Document document = builder.document();
  std::vector<std::uint32_t> visible(document.json["nodes"].size());
  std::iota(visible.begin(), visible.end(), 0U);
  Options options;
  options.select = selection.select;
  options.exclude = selection.exclude;
  std::vector<Warning> unwanted;
  const auto result = receiving_nodes(document, visible, options, warnings != nullptr ? *warnings : unwanted);
  EXPECT_TRUE(result) << result.error().text();
  return result ? *result : std::vector<std::uint8_t>();
}

TEST(SelectNodes, EverythingReceivesByDefault) { EXPECT_THAT(receiving(village(), {}), ElementsAre(1, 1, 1, 1, 1, 1)); }

TEST(SelectNodes, SelectedNodesReceiveWithAllBelow) {
  EXPECT_THAT(receiving(village(), {{"house"}, {}}), ElementsAre(1, 1, 1, 1, 0, 0));
  EXPECT_THAT(receiving(village(), {{"tree*", "wall"}, {}}), ElementsAre(0, 1, 0, 0, 0, 1));
}

TEST(SelectNodes, ExcludedNodesDoNot) {
  EXPECT_THAT(receiving(village(), {{}, {"lamp"}}), ElementsAre(1, 1, 0, 0, 1, 1));
  EXPECT_THAT(receiving(village(), {{"house"}, {"?all"}}), ElementsAre(1, 0, 1, 1, 0, 0));
}

TEST(SelectNodes, TheNearestOneThatIsNamedDecides) {
  EXPECT_THAT(receiving(village(), {{"bulb"}, {"house"}}), ElementsAre(0, 0, 0, 1, 0, 0));
  EXPECT_THAT(receiving(village(), {{"*"}, {"*"}}), ElementsAre(0, 0, 0, 0, 0, 0)) << "exclude has the last word";
}

TEST(SelectNodes, TheFileMayIgnoreNodesAndIsOverruledByName) {
  GltfBuilder builder = village();
  builder.json["nodes"][kHouse]["extras"]["radiosity"]["ignore"] = true;
  builder.json["nodes"][kLamp]["extras"]["radiosity"]["ignore"] = false;
  EXPECT_THAT(receiving(builder, {}), ElementsAre(0, 0, 1, 1, 1, 1));
  EXPECT_THAT(receiving(builder, {{"house"}, {}}), ElementsAre(1, 1, 1, 1, 0, 0));
}

TEST(SelectNodes, AnIgnoreThatMakesNoSenseIsWarnedAbout) {
  GltfBuilder builder = village();
  builder.json["nodes"][kLamp]["extras"]["radiosity"]["ignore"] = "yes";
  std::vector<Warning> warnings;
  EXPECT_THAT(receiving(builder, {}, &warnings), ElementsAre(1, 1, 1, 1, 1, 1));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].code, "bad-ignore");
  EXPECT_EQ(warnings[0].place, "nodes[2]");
}

TEST(SelectNodes, APatternThatFitsNothingIsAMistake) {
  const Document document = village().document();
  Options options;
  options.exclude = {"hous"};
  std::vector<Warning> warnings;
  const auto result = receiving_nodes(document, std::vector<std::uint32_t>{0, 1}, options, warnings);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kBadOption);
  EXPECT_EQ(result.error().text(), "--exclude: no node of the scene is called \"hous\"");
}

}  // namespace
}  // namespace gltf_radiosity
