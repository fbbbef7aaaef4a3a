#include "core/mesh/patches.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "core/photometry.h"
#include "tests/core/test_meshes.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

using test::holds;

Patches patches_of(const Scene& scene, int max_patches) {
  const RayScene rays(scene);
  return make_patches(rays, {.max_patches = max_patches}, {});
}

/// Area of everything that sends light, both sides of two-sided surfaces, m2.
double sending_area(const Scene& scene) {
  double area = 0.0;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const double sides = scene.surfaces[scene.surface_of_triangle[t]].two_sided ? 2.0 : 1.0;
    area += sides * 0.5 * double{glm::length(scaled_normal(scene, t))};
  }
  return area;
}

double sum(std::span<const float> values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// The triangle that holds a point of the scene, and where.
std::pair<std::uint32_t, Barycentrics> find(const Scene& scene, const SurfacePoint& point) {
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const glm::dvec3 a = scene.positions[scene.triangles[t].x], b = scene.positions[scene.triangles[t].y],
                     c = scene.positions[scene.triangles[t].z], p = point.position;
    const glm::dvec3 n = glm::cross(b - a, c - a);
    const double n2 = glm::dot(n, n);
    const Barycentrics at(glm::dot(glm::cross(p - a, c - a), n) / n2, glm::dot(glm::cross(b - a, p - a), n) / n2);
    const bool in_plane = std::abs(glm::dot(p - a, n)) < 1e-6 * std::sqrt(n2);
    if (in_plane && holds({}, at)) return {t, at};
  }
  return {kNothing, {}};
}

std::vector<std::pair<std::string, Scene>> scenes() {
  return {{"box", test::box_room({2, 1, 3}, {})},
          {"cornell", test::cornell_box()},
          {"occluder", test::occluder()},
          {"boxes", test::many_boxes(10, 1)},
          {"tessellated", test::tessellated(test::occluder(), 5)}};
}

/// Reflects and emits more where the first barycentric coordinate is larger.
struct Ramp final : SurfaceDetail {
  Rgb reflectance(std::uint32_t, const SubTriangle& part) const override { return Rgb(middle_of(part).x); }
  Rgb emission(std::uint32_t, const SubTriangle& part) const override { return Rgb(10.0F * middle_of(part).x); }
  float opacity(std::uint32_t, Barycentrics) const override { return 1.0F; }
};

TEST(Patches, CoverTheArea) {
  for (const auto& [name, scene] : scenes()) {
    const Patches patches = patches_of(scene, 500);
    EXPECT_NEAR(sum(patches.area) / sending_area(scene), 1.0, 1e-5) << name;
    for (const float area : patches.area) EXPECT_GT(area, 0.0F) << name;
  }
}

TEST(Patches, KeepBelowTheirLimit) {
  for (const auto& [name, scene] : scenes()) {
    for (const int most : {60, 500, 3000}) {
      const std::uint32_t count = patches_of(scene, most).patch_count();
      EXPECT_LE(count, static_cast<std::uint32_t>(most)) << name;
      EXPECT_GE(count, static_cast<std::uint32_t>(most) / 4) << name;
    }
  }
}

TEST(Patches, KeepBelowTheirLimitWhereManyAreSplit) {
  const std::vector<std::pair<std::string, Scene>> cluttered = {{"boxes", test::many_boxes(60, 3)},
                                                                {"rooms", test::rooms_on_one_floor(0.873F, 0.002F)},
                                                                {"sunk box", test::sunk_box(0.5F)},
                                                                {"wall", test::wall_through_floor(0.5F)},
                                                                {"panel", test::panel_before_wall(0.001F)}};
  for (const auto& [name, scene] : cluttered) {
    for (const int most : {60, 500, 2000}) {
      EXPECT_LE(patches_of(scene, most).patch_count(), static_cast<std::uint32_t>(most)) << name;
    }
  }
}

// Found by fuzz_bake: every size that was tried made all the tiles of such triangles, for a minute.
TEST(Patches, AreFewWhereTrianglesAreAsLongAsTheSceneAndThin) {
  Scene scene = test::box_room({2, 1, 3}, {});
  for (glm::vec3& position : scene.positions) position *= glm::vec3(1e6F, 1.0F, 1.0F);
  EXPECT_LE(patches_of(scene, 60).patch_count(), 60U);
}

TEST(Patches, AreOneWhereNoLightComes) {
  // Behind the wall it is dark; the light's own room has nearly all the patches.
  const Scene scene = test::rooms_on_one_floor(0.5F, 0.1F);
  const Patches patches = patches_of(scene, 600);
  ASSERT_NE(patches.unreached, kNothing);
  EXPECT_EQ(patches.unreached, patches.patch_count() - 1);
  EXPECT_EQ(patches.reflectance[patches.unreached], Rgb(0.0F));
  EXPECT_GT(patches.patch_count(), 300U);
  EXPECT_LE(patches.patch_count(), 600U);
  EXPECT_NEAR(patches.area[patches.unreached] / (2.0 * 1.0 + 4.0 * 1.4), 1.0, 0.15);  // ends, and four long walls
}

TEST(Patches, GroupADenseMesh) {
  const Scene coarse = test::box_room({2, 1, 3}, {});
  const auto coarse_count = static_cast<double>(patches_of(coarse, 600).patch_count());
  const auto dense_count = static_cast<double>(patches_of(test::tessellated(coarse, 64), 600).patch_count());
  EXPECT_NEAR(dense_count / coarse_count, 1.0, 0.25);  // 1.18: cells cut by the room's edges hold small tiles only
}

TEST(Patches, AreAboutAsLargeAsTheGridsCells) {
  const Patches patches = patches_of(test::box_room({2, 1, 3}, {}), 600);
  for (const float area : patches.area) EXPECT_LE(area, 1.5F * patches.size * patches.size * 1.5F);
}

TEST(Patches, LieOnBothSidesOfATwoSidedSurface) {
  Scene scene = test::parallel_squares(1.0F);
  const std::uint32_t one_sided_count = patches_of(scene, 100).patch_count();
  for (Surface& surface : scene.surfaces) surface.two_sided = true;
  const Patches patches = patches_of(scene, 10'000);
  const std::set<std::uint32_t> fronts(patches.patch_of_tile.begin(), patches.patch_of_tile.end());
  const std::set<std::uint32_t> backs(patches.back_patch_of_tile.begin(), patches.back_patch_of_tile.end());
  EXPECT_GT(one_sided_count, 0U);
  EXPECT_EQ(fronts.size(), backs.size());
  EXPECT_EQ(fronts.size() + backs.size(), patches.patch_count());
  for (const std::uint32_t front : fronts) EXPECT_FALSE(backs.contains(front));
}

TEST(Patches, LeaveTheBackOfAOneSidedSurfaceDark) {
  const Patches patches = patches_of(test::cornell_box(), 200);
  EXPECT_EQ(patches.patch_at(0, {0.3F, 0.3F}, true), kNothing);
  EXPECT_NE(patches.patch_at(0, {0.3F, 0.3F}, false), kNothing);
}

TEST(Patches, HoldTheirPoints) {
  for (const auto& [name, scene] : scenes()) {
    const Patches patches = patches_of(scene, 300);
    for (std::uint32_t p = 0; p < patches.patch_count(); ++p) {
      for (const SurfacePoint& point : patches.points_of(p)) {
        const auto [triangle, at] = find(scene, point);
        ASSERT_NE(triangle, kNothing) << name;
        EXPECT_TRUE(patches.patch_at(triangle, at, false) == p || patches.patch_at(triangle, at, true) == p) << name;
      }
    }
  }
}

TEST(Patches, LookToTheirSide) {
  for (const auto& [name, scene] : scenes()) {
    const Patches patches = patches_of(scene, 300);
    for (std::uint32_t p = 0; p < patches.patch_count(); ++p) {
      for (const SurfacePoint& point : patches.points_of(p)) {
        const auto [triangle, at] = find(scene, point);
        ASSERT_NE(triangle, kNothing) << name;
        const bool back = glm::dot(point.normal, scaled_normal(scene, triangle)) < 0.0F;
        EXPECT_EQ(patches.patch_at(triangle, at, back), p) << name;
        EXPECT_NEAR(glm::length(point.normal), 1.0F, 1e-5F) << name;
      }
    }
  }
}

TEST(Patches, KeepSurfacesAndDirectionsApart) {
  const Scene scene = test::unit_cube_faces();
  const Patches patches = patches_of(scene, 200);
  std::vector<std::uint32_t> surface_of_patch(patches.patch_count(), kNothing);
  for (const Tile& tile : patches.tiling.leaves()) {
    std::uint32_t& surface = surface_of_patch[patches.patch_of_tile[tile.tile]];
    if (surface == kNothing) surface = scene.surface_of_triangle[tile.triangle];
    EXPECT_EQ(surface, scene.surface_of_triangle[tile.triangle]);
  }
}

TEST(Patches, AverageWhatVaries) {
  const Ramp ramp;
  Scene scene = test::parallel_squares(1.0F);
  scene.surfaces[1].varies = true;
  scene.detail = &ramp;
  const Patches patches = patches_of(scene, 200);
  double reflected = 0.0;
  for (std::uint32_t p = 0; p < patches.patch_count(); ++p)
    reflected += double{patches.area[p] * patches.reflectance[p].x};
  EXPECT_NEAR(reflected, 1.0 / 3.0, 1e-4);  // the mean of a coordinate over a triangle; square 0 is black
}

TEST(Patches, KeepReflectanceBelowTheLimitAndSaySo) {
  const Patches white = patches_of(test::white_furnace(1.0F, 1.0F), 100);
  for (const Rgb& reflectance : white.reflectance) EXPECT_LE(reflectance.y, kMaxReflectance);
  EXPECT_NEAR(white.reflectance_clamped_area, 6.0, 1e-4);
  EXPECT_EQ(patches_of(test::white_furnace(0.9F, 1.0F), 100).reflectance_clamped_area, 0.0);
}

TEST(Patches, SetLampsApart) {
  const Scene scene = test::cornell_box();
  const Patches patches = patches_of(scene, 1000);
  double area = 0.0;
  for (const EmissiveTile& lamp : patches.lamps) {
    EXPECT_EQ(lamp.luminance, Rgb(17.0F, 12.0F, 4.0F));
    const glm::vec3 scaled = glm::cross(lamp.corner[1] - lamp.corner[0], lamp.corner[2] - lamp.corner[0]);
    EXPECT_LT(scaled.y, 0.0F);
    area += 0.5 * double{glm::length(scaled)};
  }
  EXPECT_NEAR(area, 0.13 * 0.105, 1e-6);
  for (const Rgb& glow : patches.glow) EXPECT_EQ(glow, Rgb(0.0F));
}

TEST(Patches, LoseNoFluxWhenThereAreMoreEmissiveTrianglesThanLamps) {
  const Ramp ramp;
  Scene scene = test::tessellated(test::white_furnace(0.5F, 1.0F), 28);
  scene.surfaces[0].varies = true;
  scene.detail = &ramp;
  const Patches patches = patches_of(scene, 9000);
  ASSERT_EQ(patches.lamps.size(), kMaxLamps);

  double lamps = 0.0, remainder = 0.0;
  for (const EmissiveTile& lamp : patches.lamps) {
    const glm::vec3 scaled = glm::cross(lamp.corner[1] - lamp.corner[0], lamp.corner[2] - lamp.corner[0]);
    lamps += 0.5 * double{glm::length(scaled) * lamp.luminance.y};
  }
  for (std::uint32_t p = 0; p < patches.patch_count(); ++p) remainder += double{patches.area[p] * patches.glow[p].y};
  EXPECT_NEAR(lamps + remainder, 10.0 / 3.0 * 6.0, 1e-3);
  EXPECT_NEAR(patches.glow_share, remainder / (lamps + remainder), 1e-5);
  EXPECT_NEAR(patches.glow_share, 1.0 - double{kMaxLamps} / static_cast<double>(scene.triangles.size()), 1e-3);
}

TEST(Patches, LeaveNothingToGlowWhereAllEmittersCanBeLamps) {
  // However small the patches.
  const Patches patches = patches_of(test::white_furnace(0.5F, 1.0F), 20'000);
  EXPECT_LE(patches.lamps.size(), kMaxLamps);
  EXPECT_EQ(patches.glow_share, 0.0);
}

TEST(Patches, LeaveOutTrianglesWithoutArea) {
  Scene scene = test::parallel_squares(1.0F);
  scene.triangles.emplace_back(0, 0, 1);
  scene.triangles.emplace_back(0, 1, 0);
  scene.surface_of_triangle.insert(scene.surface_of_triangle.end(), 2, 0U);
  const Patches patches = patches_of(scene, 100);
  EXPECT_EQ(patches.degenerate_triangle_count, 2U);
  EXPECT_EQ(patches.patch_at(4, {0.3F, 0.3F}, false), kNothing);
  EXPECT_NEAR(sum(patches.area), 2.0, 1e-5);
}

TEST(Patches, AreNoneInASceneWithoutArea) {
  EXPECT_EQ(patches_of({}, 100).patch_count(), 0U);
  Scene scene = test::parallel_squares(1.0F);
  for (glm::vec3& position : scene.positions) position = glm::vec3(1.0F);
  const Patches patches = patches_of(scene, 100);
  EXPECT_EQ(patches.patch_count(), 0U);
  EXPECT_EQ(patches.degenerate_triangle_count, 4U);
  EXPECT_EQ(patches.patch_at(0, {0.3F, 0.3F}, false), kNothing);
}

TEST(Patches, StopWhenCancelled) {
  const Progress cancelled{.report = {}, .cancelled = [] { return true; }};
  const Scene scene = test::cornell_box();
  const RayScene rays(scene);
  EXPECT_THROW(make_patches(rays, {}, cancelled), Cancelled);
}

}  // namespace
}  // namespace radiosity
