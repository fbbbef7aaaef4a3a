#include "core/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "core/progress.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

using testing::HasSubstr;

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();

Scene valid_scene() { return test::box_room({1, 1, 1}, Surface{}); }

/// What validate() says about a scene that must not be valid.
std::string fault_of(const Scene& scene) { return validate(scene).value_or("nothing is wrong"); }

double total_area(const Scene& scene) {
  double area = 0.0;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    area += 0.5 * static_cast<double>(glm::length(scaled_normal(scene, t)));
  }
  return area;
}

/// The volume enclosed by outward facing triangles; negative if they face inward.
double signed_volume(const Scene& scene) {
  double volume = 0.0;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    volume += static_cast<double>(glm::dot(scene.positions[scene.triangles[t].x], scaled_normal(scene, t))) / 6.0;
  }
  return volume;
}

/// Answers whatever it is told to.
struct FixedDetail final : SurfaceDetail {
  Rgb told_reflectance{0.25F};
  Rgb told_emission{3.0F};
  float told_opacity = 0.5F;
  Rgb reflectance(std::uint32_t, const SubTriangle&) const override { return told_reflectance; }
  Rgb emission(std::uint32_t, const SubTriangle&) const override { return told_emission; }
  float opacity(std::uint32_t, Barycentrics) const override { return told_opacity; }
};

TEST(Validate, AcceptsEveryTestScene) {
  const test::DetailedScene fence = test::see_through_fence();
  const std::vector<Scene> scenes = {valid_scene(),
                                     test::unit_cube_faces(),
                                     test::parallel_squares(1.0F),
                                     test::perpendicular_squares(),
                                     test::cornell_box(),
                                     test::white_furnace(0.5F, 1.0F),
                                     test::occluder(),
                                     test::many_boxes(20, 1),
                                     test::tessellated(test::cornell_box(), 3),
                                     fence.scene,
                                     Scene{}};
  for (const Scene& scene : scenes) {
    EXPECT_EQ(fault_of(scene), "nothing is wrong");
  }
}

TEST(Validate, NamesTheVertexThatIsNotFinite) {
  Scene scene = valid_scene();
  scene.positions[7].y = std::numeric_limits<float>::infinity();
  EXPECT_THAT(fault_of(scene), HasSubstr("positions[7]"));
  scene = valid_scene();
  scene.normals[3].x = kNotANumber;
  EXPECT_THAT(fault_of(scene), HasSubstr("normals[3]"));
}

TEST(Validate, NamesTheVertexThatIsTooFarAwayForAreasToBeFinite) {
  Scene scene = valid_scene();
  scene.positions[7].y = 1e8F;
  EXPECT_EQ(validate(scene), std::nullopt);
  scene.positions[7].y = 1e19F;
  EXPECT_THAT(fault_of(scene), HasSubstr("positions[7]"));
}

TEST(Validate, NamesTheTriangleWhoseIndicesAreOutOfRange) {
  Scene scene = valid_scene();
  scene.triangles[5].z = 24;
  EXPECT_THAT(fault_of(scene), HasSubstr("triangles[5] names a vertex"));
  scene = valid_scene();
  scene.surface_of_triangle[4] = 1;
  EXPECT_THAT(fault_of(scene), HasSubstr("triangles[4] names a surface"));
}

TEST(Validate, RefusesArraysOfDifferentLength) {
  Scene scene = valid_scene();
  scene.normals.pop_back();
  EXPECT_THAT(fault_of(scene), HasSubstr("normals"));
  scene = valid_scene();
  scene.surface_of_triangle.pop_back();
  EXPECT_THAT(fault_of(scene), HasSubstr("surface indices"));
}

TEST(Validate, RefusesSurfacesThatMakeLightOrSwallowMoreThanArrives) {
  Scene scene = valid_scene();
  scene.surfaces[0].reflectance.y = 1.01F;
  EXPECT_THAT(fault_of(scene), HasSubstr("surfaces[0] has a reflectance"));
  scene.surfaces[0].reflectance.y = kNotANumber;
  EXPECT_THAT(fault_of(scene), HasSubstr("surfaces[0] has a reflectance"));
  scene = valid_scene();
  scene.surfaces[0].emission.z = -1.0F;
  EXPECT_THAT(fault_of(scene), HasSubstr("surfaces[0] has an emission"));
}

TEST(Validate, AsksForDetailWhereASurfaceNeedsIt) {
  Scene scene = valid_scene();
  scene.surfaces[0].see_through = true;
  EXPECT_THAT(fault_of(scene), HasSubstr("detail"));
  const FixedDetail detail;
  scene.detail = &detail;
  EXPECT_EQ(fault_of(scene), "nothing is wrong");
}

TEST(Validate, RefusesLightsThatMakeNoSense) {
  const auto fault_with = [](const Light& light) {
    Scene scene = valid_scene();
    scene.lights = {Light{}, light};
    return fault_of(scene);
  };
  EXPECT_EQ(fault_with(Light{}), "nothing is wrong");
  EXPECT_THAT(fault_with({.intensity = Rgb(-1.0F)}), HasSubstr("lights[1] has an intensity"));
  EXPECT_THAT(fault_with({.position = glm::vec3(kNotANumber)}), HasSubstr("lights[1] has a position"));
  EXPECT_THAT(fault_with({.kind = Light::Kind::kSpot, .direction = {0, 2, 0}}), HasSubstr("lights[1] has a direction"));
  EXPECT_THAT(fault_with({.range = -1.0F}), HasSubstr("lights[1] has a negative range"));
  EXPECT_THAT(fault_with({.kind = Light::Kind::kSpot, .inner_cone_cos = 0.1F, .outer_cone_cos = 0.9F}),
              HasSubstr("inner cone"));
}

TEST(Validate, RefusesANegativeSky) {
  Scene scene = valid_scene();
  scene.sky.luminance = Rgb(0.0F, -1.0F, 0.0F);
  EXPECT_THAT(fault_of(scene), HasSubstr("sky"));
}

TEST(Scene, DiagonalIsThatOfTheBoundingBox) {
  EXPECT_FLOAT_EQ(diagonal(test::box_room({2, 3, 6}, Surface{})), 7.0F);
  EXPECT_EQ(diagonal(Scene{}), 0.0F);
}

TEST(Scene, SurfaceOffsetGrowsWithTheScene) {
  const float small = surface_offset(test::box_room({1, 1, 1}, Surface{}));
  EXPECT_FLOAT_EQ(small, 2e-5F * std::sqrt(3.0F));
  EXPECT_FLOAT_EQ(surface_offset(test::box_room({100, 100, 100}, Surface{})), 100.0F * small);
}

TEST(Scene, SurfaceOffsetMovesAPointFarFromTheOrigin) {
  Scene scene = valid_scene();
  for (glm::vec3& position : scene.positions) {
    position.x += 100'000.0F;
  }
  const float offset = surface_offset(scene);
  EXPECT_GT(100'001.0F + offset, std::nextafter(100'001.0F, 200'000.0F));
  EXPECT_LT(offset, 0.5F);
}

TEST(Scene, ScaledNormalIsTwiceTheAreaAlongTheFront) {
  Scene scene = valid_scene();
  scene.positions = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}};
  scene.triangles = {{0, 1, 2}};
  EXPECT_EQ(scaled_normal(scene, 0), glm::vec3(0, 0, 6));
}

TEST(Scene, PointAtWeighsTheCorners) {
  Scene scene;
  scene.positions = {{0, 0, 0}, {4, 0, 0}, {0, 0, 8}};
  scene.triangles = {{0, 1, 2}};
  EXPECT_EQ(point_at(scene, 0, {0, 0}), glm::vec3(0, 0, 0));
  EXPECT_EQ(point_at(scene, 0, {0.25F, 0.5F}), glm::vec3(1, 0, 4));
}

TEST(Scene, MeanReflectanceStaysBelowTheLargestThatLightTransportAccepts) {
  Scene scene = valid_scene();
  scene.surfaces[0].reflectance = {1.0F, 0.5F, 0.0F};
  EXPECT_EQ(mean_reflectance(scene, 0, {}), Rgb(kMaxReflectance, 0.5F, 0.0F));
}

TEST(Scene, MeansComeFromTheDetailOnlyWhereTheSurfaceVaries) {
  Scene scene = valid_scene();
  scene.surfaces[0].emission = Rgb(7.0F);
  FixedDetail detail;
  detail.told_reflectance = {2.0F, 0.25F, -1.0F};
  scene.detail = &detail;
  EXPECT_EQ(mean_reflectance(scene, 0, {}), Rgb(0.5F));
  EXPECT_EQ(mean_emission(scene, 0, {}), Rgb(7.0F));
  scene.surfaces[0].varies = true;
  EXPECT_EQ(mean_reflectance(scene, 0, {}), Rgb(kMaxReflectance, 0.25F, 0.0F));
  EXPECT_EQ(mean_emission(scene, 0, {}), Rgb(3.0F));
}

TEST(Scene, LetsThroughTheShareOfRaysThatItsOpacityLeaves) {
  Scene scene = valid_scene();
  FixedDetail detail;
  detail.told_opacity = 0.75F;
  scene.detail = &detail;
  EXPECT_FALSE(lets_through(scene, 0, {}, 0.99F)) << "an opaque surface asked its detail";
  scene.surfaces[0].see_through = true;
  int passed = 0;
  for (int i = 0; i < 100; ++i) {
    passed += lets_through(scene, 0, {}, static_cast<float>(i) / 100.0F) ? 1 : 0;
  }
  EXPECT_EQ(passed, 25);
}

TEST(Scene, LetsEverythingThroughWhereThereIsNothingAndNothingWhereItIsOpaque) {
  Scene scene = valid_scene();
  scene.surfaces[0].see_through = true;
  FixedDetail detail;
  scene.detail = &detail;
  detail.told_opacity = 0.0F;
  EXPECT_TRUE(lets_through(scene, 0, {}, 0.0F));
  detail.told_opacity = 1.0F;
  EXPECT_FALSE(lets_through(scene, 0, {}, 0.999F));
}

TEST(Progress, ThrowsWhenTheCallerWantsToStop) {
  Progress progress;
  EXPECT_NO_THROW(progress.update("solve", 0.5));
  progress.cancelled = [] { return true; };
  EXPECT_THROW(progress.update("solve", 0.5), Cancelled);
}

TEST(Progress, ReportsBeforeItAsksWhetherToStop) {
  double seen = -1.0;
  const Progress progress{.report = [&](std::string_view, double done) { seen = done; },
                          .cancelled = [] { return true; }};
  EXPECT_THROW(progress.update("solve", 0.25), Cancelled);
  EXPECT_EQ(seen, 0.25);
}

TEST(TestScenes, RoomsAreClosedAndFaceInward) {
  EXPECT_NEAR(signed_volume(test::box_room({2, 3, 4}, Surface{})), -24.0, 1e-4);
  EXPECT_NEAR(total_area(test::box_room({2, 3, 4}, Surface{})), 52.0, 1e-4);
  EXPECT_NEAR(signed_volume(test::unit_cube_faces()), -1.0, 1e-6);
}

TEST(TestScenes, ShadingNormalsFaceAsTheTrianglesDo) {
  for (const Scene& scene : {test::cornell_box(), test::many_boxes(10, 2), test::occluder()}) {
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
      EXPECT_GT(glm::dot(scene.normals[scene.triangles[t].x], scaled_normal(scene, t)), 0.0F);
    }
  }
}

TEST(TestScenes, TheCornellLampShinesDownAndItsBlocksFaceOutward) {
  const Scene scene = test::cornell_box();
  ASSERT_EQ(scene.triangles.size(), 32U);
  EXPECT_LT(scaled_normal(scene, 30).y, 0.0F);
  EXPECT_NEAR(0.5 * glm::length(scaled_normal(scene, 30) + scaled_normal(scene, 31)), 0.13 * 0.105, 1e-6);
  const auto facing_away_from = [&](std::uint32_t first, const glm::vec3& middle) {
    for (std::uint32_t t = first; t < first + 10; ++t) {
      EXPECT_GT(glm::dot(scaled_normal(scene, t), point_at(scene, t, {0.3F, 0.3F}) - middle), 0.0F) << t;
    }
  };
  facing_away_from(10, {0.186F, 0.08F, 0.169F});
  facing_away_from(20, {0.368F, 0.16F, 0.351F});
}

TEST(TestScenes, TessellationKeepsAreaAndOrientation) {
  const Scene scene = test::cornell_box();
  const Scene fine = test::tessellated(scene, 4);
  EXPECT_EQ(fine.triangles.size(), 16U * scene.triangles.size());
  EXPECT_NEAR(total_area(fine), total_area(scene), 1e-6);
  for (std::uint32_t t = 0; t < fine.triangles.size(); ++t) {
    EXPECT_GT(glm::dot(scaled_normal(fine, t), scaled_normal(scene, t / 16)), 0.0F);
    EXPECT_EQ(fine.surface_of_triangle[t], scene.surface_of_triangle[t / 16]);
  }
}

TEST(TestScenes, HalfOfTheFenceIsOpaque) {
  const test::DetailedScene fence = test::see_through_fence();
  int opaque = 0;
  for (int i = 0; i < 1000; ++i) {
    // Along x across the first triangle of the fence: from corner 1 to corner 2.
    const float s = (static_cast<float>(i) + 0.5F) / 1000.0F;
    opaque += lets_through(fence.scene, 2, {1.0F - s, s}, 0.5F) ? 0 : 1;
  }
  EXPECT_EQ(opaque, 500);
}

}  // namespace
}  // namespace radiosity
