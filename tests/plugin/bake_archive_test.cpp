#include "plugin/bake_archive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/plugin/bake_by_hand.h"

namespace gltf_radiosity {
namespace {

using testing::HasSubstr;

class BakeArchive : public testing::Test {
 protected:
  void SetUp() override {
    GltfBuilder builder;
    builder.add_node(builder.add_mesh(unit_square()));
    hand_ = bake_by_hand(builder, 2, {1.0F, 2.0F, 3.0F});
    hand_.bake.report.patch_count = 17;
    hand_.bake.report.estimated_error = 0.25;
  }
  Result<radiosity::Bake> through_a_file(const radiosity::Bake& bake) {
    ArchiveWriter archive(kBakeArchive);
    add_bake(archive, bake);
    EXPECT_TRUE(archive.write(folder_ / "bake"));
    const auto& scene = hand_.scene.scene;
    return read_bake(Archive::open(folder_ / "bake", kBakeArchive).value(), scene.positions.size(),
                     scene.triangles.size());
  }

  const TemporaryFolder folder_;
  HandBake hand_;
};

TEST_F(BakeArchive, GivesBackTheSameBake) {
  const Result<radiosity::Bake> read = through_a_file(hand_.bake);
  ASSERT_TRUE(read) << read.error().text();
  const auto& expected = hand_.bake.mesh;
  EXPECT_EQ(read->mesh.scene_vertex_count, expected.scene_vertex_count);
  EXPECT_EQ(read->mesh.cuts, expected.cuts);
  EXPECT_EQ(read->mesh.positions, expected.positions);
  EXPECT_EQ(read->mesh.normals, expected.normals);
  EXPECT_EQ(read->mesh.elements, expected.elements);
  EXPECT_EQ(read->mesh.triangle_of_element, expected.triangle_of_element);
  ASSERT_EQ(read->mesh.part_of_element.size(), expected.part_of_element.size());
  EXPECT_EQ(read->mesh.part_of_element[3].corner[1], expected.part_of_element[3].corner[1]);
  EXPECT_EQ(read->irradiance, hand_.bake.irradiance);
  EXPECT_EQ(read->report.patch_count, 17U);
  EXPECT_EQ(read->report.estimated_error, 0.25);
}

TEST_F(BakeArchive, WhatDoesNotFitTogetherIsRefused) {
  const auto wrong = [&](const auto& change) {
    radiosity::Bake bake = hand_.bake;
    change(bake);
    const Result<radiosity::Bake> read = through_a_file(bake);
    return read ? std::string("nothing") : read.error().text();
  };
  EXPECT_THAT(wrong([](auto& bake) { bake.mesh.elements[0].z = 1'000'000; }), HasSubstr("'elements' is damaged"));
  EXPECT_THAT(wrong([](auto& bake) { bake.mesh.cuts[0].ends.x = 4'000'000'000U; }), HasSubstr("'cuts' is damaged"));
  EXPECT_THAT(wrong([](auto& bake) { bake.mesh.cuts.pop_back(); }), HasSubstr("'cuts' is damaged"));
  EXPECT_THAT(wrong([](auto& bake) { bake.mesh.triangle_of_element.back() = 99; }),
              HasSubstr("'triangles' is damaged"));
  EXPECT_THAT(wrong([](auto& bake) { bake.mesh.normals.pop_back(); }), HasSubstr("'normals' is damaged"));
  EXPECT_THAT(wrong([](auto& bake) { bake.irradiance.pop_back(); }), HasSubstr("'irradiance' is damaged"));
  EXPECT_THAT(wrong([](auto& bake) { bake.mesh.part_of_element.pop_back(); }), HasSubstr("'parts' is damaged"));
}

}  // namespace
}  // namespace gltf_radiosity
