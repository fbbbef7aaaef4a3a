#include "core/visibility/item_buffer.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <string>
#include <thread>

#include "core/visibility/item_buffer_raster.h"
#include "core/visibility/item_buffer_rays.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

/// Both makers over one scene.
struct Makers {
  explicit Makers(const Scene& scene)
      : rays_scene(scene), raster(make_item_buffer_raster(scene)), rays(make_item_buffer_rays(rays_scene)) {}
  RayScene rays_scene;
  std::unique_ptr<ItemBufferMaker> raster, rays;
};

class EachMaker : public testing::TestWithParam<bool> {
 protected:
  static ItemBuffer fill(const Scene& scene, int resolution, const Viewpoint& viewpoint) {
    ItemBuffer items;
    const Makers makers(scene);
    maker(makers).fill(Hemicube(resolution), viewpoint, items);
    return items;
  }
  static const ItemBufferMaker& maker(const Makers& makers) { return GetParam() ? *makers.rays : *makers.raster; }
};
INSTANTIATE_TEST_SUITE_P(ItemBuffer, EachMaker, testing::Bool(),
                         [](const auto& value) { return value.param ? "Rays" : "Raster"; });

/// A viewpoint at a random place on a random triangle, lifted off its front.
Viewpoint random_viewpoint(const Scene& scene, std::mt19937& random) {
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  const auto triangle = static_cast<std::uint32_t>(random() % scene.triangles.size());
  Barycentrics at(unit(random), unit(random));
  at = at.x + at.y > 1.0F ? Barycentrics(1.0F - at.x, 1.0F - at.y) : at;
  const glm::vec3 normal = glm::normalize(scaled_normal(scene, triangle));
  return {point_at(scene, triangle, at) + surface_offset(scene) * normal, normal,
          low_discrepancy_twist(static_cast<std::uint32_t>(random()))};
}

/// Share of a hemicube that sees a triangle for which `wanted` holds.
double form_factor(const Hemicube& hemicube, const ItemBuffer& items,
                   const std::function<bool(std::uint32_t)>& wanted) {
  double sum = 0.0;
  for (std::size_t i = 0; i < items.triangle.size(); ++i) {
    sum += wanted(items.triangle[i]) ? static_cast<double>(hemicube.delta_form_factors()[i]) : 0.0;
  }
  return sum;
}

// ---- agreement of the makers ----

struct NamedScene {
  std::string name;
  std::function<test::DetailedScene()> make;
};

class Agreement : public testing::TestWithParam<NamedScene> {};

NamedScene plain(const std::string& name, const std::function<Scene()>& make) {
  return {name, [make] { return test::DetailedScene{nullptr, make()}; }};
}

INSTANTIATE_TEST_SUITE_P(
    ItemBuffer, Agreement,
    testing::Values(plain("BoxRoom",
                          [] {
                            return test::box_room({4.0F, 2.5F, 6.0F}, {});
                          }),
                    plain("UnitCubeFaces", test::unit_cube_faces),
                    plain("ParallelSquares", [] { return test::parallel_squares(0.5F); }),
                    plain("PerpendicularSquares", test::perpendicular_squares), plain("CornellBox", test::cornell_box),
                    plain("CornellBoxTessellated", [] { return test::tessellated(test::cornell_box(), 9); }),
                    plain("Occluder", test::occluder), plain("ManyBoxes", [] { return test::many_boxes(150, 7); }),
                    plain("ManyMoreBoxes", [] { return test::many_boxes(3000, 8); }),
                    NamedScene{"SeeThroughFence", test::see_through_fence}),
    [](const auto& value) { return value.param.name; });

/// Where a cell's surface is in the world.
glm::vec3 seen_point(const Scene& scene, const ItemBuffer& items, std::size_t cell) {
  return point_at(scene, items.triangle[cell], items.barycentrics[cell]);
}

TEST_P(Agreement, BothMakersSeeTheSameSurfaceInAlmostEveryCell) {
  const test::DetailedScene world = GetParam().make();
  const Scene& scene = world.scene;
  const Makers makers(scene);
  const float tolerance = 1e-4F * diagonal(scene);
  std::mt19937 random(11);
  std::size_t cells = 0;
  std::size_t different = 0;
  std::size_t elsewhere = 0;
  for (const int resolution : {6, 16, 34, 64}) {
    const Hemicube hemicube(resolution);
    for (int k = 0; k < 30; ++k) {
      const Viewpoint viewpoint = random_viewpoint(scene, random);
      ItemBuffer raster;
      ItemBuffer rays;
      makers.raster->fill(hemicube, viewpoint, raster);
      makers.rays->fill(hemicube, viewpoint, rays);
      cells += raster.triangle.size();
      for (std::size_t i = 0; i < raster.triangle.size(); ++i) {
        if (raster.triangle[i] != rays.triangle[i]) {
          ++different;
        } else if (raster.triangle[i] != kNothing) {
          const glm::vec3 a = seen_point(scene, raster, i);
          const glm::vec3 b = seen_point(scene, rays, i);
          // Along a grazing surface the same cell may be met a little further on.
          elsewhere += glm::distance(a, b) > tolerance ? 1U : 0U;
          EXPECT_EQ(raster.back[i], rays.back[i]);
        }
      }
    }
  }
  const double share = static_cast<double>(different) / static_cast<double>(cells);
  RecordProperty("different_share", std::to_string(share));
  EXPECT_LT(share, 0.005) << different << " of " << cells;
  EXPECT_LT(static_cast<double>(elsewhere) / static_cast<double>(cells), 0.001) << elsewhere << " of " << cells;
}

// ---- closed forms ----

TEST_P(EachMaker, SeesTheOppositeFaceOfACubeFromTheCentreOfAFace) {
  const Scene scene = test::unit_cube_faces();
  const Hemicube hemicube(128);
  const ItemBuffer items = fill(scene, 128, {{0.5F, 1e-6F, 0.5F}, {0.0F, 1.0F, 0.0F}, 0.3F});
  const double opposite = form_factor(hemicube, items, [](std::uint32_t t) { return t / 2 == 3; });
  EXPECT_NEAR(opposite, 0.239456, 0.239456 * 0.001);
  for (const std::uint32_t wall : {0U, 1U, 4U, 5U}) {
    const double adjacent = form_factor(hemicube, items, [wall](std::uint32_t t) { return t / 2 == wall; });
    EXPECT_NEAR(adjacent, (1.0 - 0.239456) / 4.0, 0.0005) << wall;
  }
  EXPECT_EQ(form_factor(hemicube, items, [](std::uint32_t t) { return t / 2 == 2; }), 0.0);
}

/// A regular polygon facing down, `radius` wide at `height` over the origin.
Scene disc(float radius, float height, std::uint32_t corners) {
  Scene scene;
  scene.surfaces.resize(1);
  scene.positions.emplace_back(0.0F, height, 0.0F);
  for (std::uint32_t i = 0; i < corners; ++i) {
    const float angle = 2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(corners);
    scene.positions.emplace_back(radius * std::cos(angle), height, radius * std::sin(angle));
    scene.triangles.emplace_back(0, 1 + i, 1 + (i + 1) % corners);
    scene.surface_of_triangle.push_back(0);
  }
  scene.normals.resize(scene.positions.size(), glm::vec3(0.0F));
  return scene;
}

TEST_P(EachMaker, SeesACoaxialDiscUnderItsFormFactor) {
  const Hemicube hemicube(128);
  for (const auto& [radius, height] : {std::pair(1.0F, 1.0F), std::pair(0.5F, 2.0F), std::pair(5.0F, 1.0F)}) {
    const ItemBuffer items = fill(disc(radius, height, 360), 128, {glm::vec3(0.0F), {0.0F, 1.0F, 0.0F}, 0.2F});
    const double expected = static_cast<double>(radius * radius / (radius * radius + height * height));
    EXPECT_NEAR(form_factor(hemicube, items, [](std::uint32_t t) { return t != kNothing; }), expected, 0.01 * expected);
  }
}

// ---- nothing lost, nothing invented ----

TEST_P(EachMaker, FindsAWallInEveryDirectionInsideAClosedRoom) {
  const Scene scene = test::tessellated(test::box_room({5.0F, 3.0F, 4.0F}, {}), 13);
  const Makers makers(scene);
  const Hemicube hemicube(32);
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(0.01F, 0.99F);
  std::normal_distribution<float> normal;
  ItemBuffer items;
  int holes = 0;
  int backs = 0;
  for (int k = 0; k < 200; ++k) {
    const glm::vec3 position = glm::vec3(5.0F, 3.0F, 4.0F) * glm::vec3(unit(random), unit(random), unit(random));
    const glm::vec3 direction = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
    maker(makers).fill(hemicube, {position, direction, unit(random)}, items);
    for (std::size_t i = 0; i < items.triangle.size(); ++i) {
      holes += items.triangle[i] == kNothing ? 1 : 0;
      backs += items.back[i];
    }
  }
  EXPECT_EQ(holes, 0);
  EXPECT_EQ(backs, 0);
}

TEST_P(EachMaker, FindsNoHoleWhereCellsLookStraightAtEdgesAndCorners) {
  // In the middle of a cube whose walls are cut into cells, with the hemicube in line with them: at 26 cells every
  // second edge of 13 x 13 tiles, and the diagonals, meet the centres of cells exactly.
  const Scene scene = test::tessellated(test::box_room({2.0F, 2.0F, 2.0F}, {}), 13);
  const Makers makers(scene);
  ItemBuffer items;
  for (const int resolution : {2, 26, 52, 78}) {
    const Hemicube hemicube(resolution);
    for (const glm::vec3 normal : {glm::vec3(1, 0, 0), glm::vec3(0, -1, 0), glm::vec3(0, 0, -1)}) {
      maker(makers).fill(hemicube, {{1.0F, 1.0F, 1.0F}, normal, 0.0F}, items);
      EXPECT_EQ(std::count(items.triangle.begin(), items.triangle.end(), kNothing), 0) << resolution;
    }
  }
}

TEST_P(EachMaker, BarycentricsLeadToThePointInTheDirectionOfTheCell) {
  const Scene scene = test::cornell_box();
  const Hemicube hemicube(22);
  std::mt19937 random(4);
  const Makers makers(scene);
  for (int k = 0; k < 20; ++k) {
    const Viewpoint viewpoint = random_viewpoint(scene, random);
    const Frame axes = frame(viewpoint);
    ItemBuffer items;
    maker(makers).fill(hemicube, viewpoint, items);
    for (std::size_t i = 0; i < items.triangle.size(); ++i) {
      if (items.triangle[i] == kNothing) {
        continue;
      }
      const Barycentrics at = items.barycentrics[i];
      EXPECT_GE(at.x, -1e-5F);
      EXPECT_GE(at.y, -1e-5F);
      EXPECT_LE(at.x + at.y, 1.0F + 1e-5F);
      const glm::vec3 d = hemicube.directions()[i];
      const glm::vec3 world = d.x * axes.u + d.y * axes.v + d.z * axes.w;
      const glm::vec3 to_point = seen_point(scene, items, i) - viewpoint.position;
      EXPECT_LT(glm::length(glm::cross(world, to_point)), 1e-4F) << "cell " << i;
      EXPECT_GT(glm::dot(world, to_point), 0.0F);
    }
  }
}

TEST_P(EachMaker, FlagsTrianglesSeenFromBehind) {
  const Scene scene = test::parallel_squares(1.0F);
  const Hemicube hemicube(8);
  const ItemBuffer from_front = fill(scene, 8, {{0.5F, 0.5F, 0.5F}, {0.0F, 0.0F, 1.0F}, 0.0F});
  const ItemBuffer from_behind = fill(scene, 8, {{0.5F, 0.5F, -0.5F}, {0.0F, 0.0F, 1.0F}, 0.0F});
  int front_hits = 0;
  int behind_hits = 0;
  for (std::size_t i = 0; i < from_front.triangle.size(); ++i) {
    front_hits += from_front.triangle[i] == kNothing ? 0 : 1;
    EXPECT_EQ(from_front.back[i], 0);
    if (from_behind.triangle[i] != kNothing) {
      ++behind_hits;
      EXPECT_EQ(from_behind.back[i], from_behind.triangle[i] < 2 ? 1 : 0);
    }
  }
  EXPECT_GT(front_hits, 10);
  EXPECT_GT(behind_hits, 10);
}

TEST_P(EachMaker, OverwritesEveryCellAndIgnoresDegenerateTriangles) {
  Scene scene = test::parallel_squares(1.0F);
  scene.triangles.emplace_back(0, 0, 1);
  scene.triangles.emplace_back(0, 1, 1);
  scene.surface_of_triangle.insert(scene.surface_of_triangle.end(), 2, 0);
  const Makers makers(scene);
  ItemBuffer items;
  items.triangle.assign(1000, 99);
  items.back.assign(1000, 9);
  maker(makers).fill(Hemicube(6), {{0.5F, 0.5F, 0.5F}, {0.0F, 0.0F, 1.0F}, 0.0F}, items);
  ASSERT_EQ(items.triangle.size(), 108U);
  ASSERT_EQ(items.barycentrics.size(), 108U);
  ASSERT_EQ(items.back.size(), 108U);
  for (const std::uint32_t triangle : items.triangle) {
    EXPECT_TRUE(triangle == 2 || triangle == 3 || triangle == kNothing) << triangle;
  }
  // And looking away there is nothing.
  maker(makers).fill(Hemicube(6), {{0.5F, 0.5F, 1.5F}, {0.0F, 0.0F, 1.0F}, 0.0F}, items);
  EXPECT_EQ(std::count(items.triangle.begin(), items.triangle.end(), kNothing), 108);
}

TEST_P(EachMaker, SeesNothingInAnEmptyScene) {
  const ItemBuffer items = fill({}, 4, {});
  EXPECT_EQ(items.triangle, std::vector<std::uint32_t>(48, kNothing));
}

// ---- see-through surfaces ----

TEST(OpacityThreshold, IsSpreadEvenlyAndDependsOnTheViewpoint) {
  for (int k = 0; k < 20; ++k) {
    const Viewpoint viewpoint{{static_cast<float>(k), 0.0F, 0.0F}, {0.0F, 0.0F, 1.0F}, 0.0F};
    std::array<int, 10> histogram{};
    for (int cell = 0; cell < 3072; ++cell) {
      const float threshold = opacity_threshold(viewpoint, cell);
      ASSERT_GE(threshold, 0.0F);
      ASSERT_LT(threshold, 1.0F);
      ++histogram[static_cast<std::size_t>(threshold * 10.0F)];
    }
    for (const int count : histogram) {
      EXPECT_NEAR(count, 307, 10);
    }
  }
  std::array<int, 4> of_first_cell{};
  for (int k = 0; k < 4000; ++k) {
    const float x = static_cast<float>(k) * 0.01F;
    ++of_first_cell[static_cast<std::size_t>(opacity_threshold({{x, 1.0F, 2.0F}, {0.0F, 0.0F, 1.0F}, 0.0F}, 0) * 4.0F)];
  }
  for (const int count : of_first_cell) {
    EXPECT_NEAR(count, 1000, 100);
  }
}

class Glass : public SurfaceDetail {
 public:
  Rgb reflectance(std::uint32_t, const SubTriangle&) const override { return Rgb(0.5F); }
  Rgb emission(std::uint32_t, const SubTriangle&) const override { return Rgb(0.0F); }
  float opacity(std::uint32_t, Barycentrics) const override { return 0.5F; }
};

TEST_P(EachMaker, HalfOpaqueWallLetsHalfTheCellsThrough) {
  const Glass glass;
  Scene scene = test::box_room({4.0F, 4.0F, 4.0F}, {});
  Scene inner = test::box_room({1.0F, 1.0F, 1.0F}, {});
  const auto first_vertex = static_cast<std::uint32_t>(scene.positions.size());
  for (std::size_t i = 0; i < inner.positions.size(); ++i) {
    scene.positions.push_back(inner.positions[i] + glm::vec3(1.5F));
    scene.normals.push_back(inner.normals[i]);
  }
  scene.surfaces.push_back({.see_through = true});
  for (const glm::uvec3& triangle : inner.triangles) {
    scene.triangles.push_back(triangle + first_vertex);
    scene.surface_of_triangle.push_back(1);
  }
  scene.detail = &glass;

  const Hemicube hemicube(32);
  const Makers makers(scene);
  ItemBuffer items;
  for (int k = 0; k < 10; ++k) {
    const glm::vec3 position(1.6F + 0.08F * static_cast<float>(k), 2.0F, 2.1F);
    maker(makers).fill(hemicube, {position, {0.0F, 0.6F, 0.8F}, 0.1F}, items);
    const double behind = form_factor(hemicube, items, [](std::uint32_t t) { return t < 12; });
    EXPECT_NEAR(behind, 0.5, 0.02);
    EXPECT_EQ(form_factor(hemicube, items, [](std::uint32_t t) { return t == kNothing; }), 0.0);
  }
}

TEST_P(EachMaker, SeesThroughTheGapsOfAFence) {
  const test::DetailedScene fence = test::see_through_fence();
  const Hemicube hemicube(64);
  const Viewpoint viewpoint{{0.03F, 0.001F, -0.04F}, {0.0F, 1.0F, 0.0F}, 0.4F};
  const Frame axes = frame(viewpoint);
  const ItemBuffer items = fill(fence.scene, 64, viewpoint);
  int at_fence = 0;
  for (std::size_t i = 0; i < items.triangle.size(); ++i) {
    // Where the cell's ray meets the plane of the fence, if not too near the edge of a stripe or of the fence.
    const glm::vec3 d = hemicube.directions()[i];
    const glm::vec3 world = d.x * axes.u + d.y * axes.v + d.z * axes.w;
    const glm::vec3 at = viewpoint.position + world * ((1.0F - viewpoint.position.y) / world.y);
    const float stripe = at.x / 0.125F;
    if (std::abs(at.x) > 0.499F || std::abs(at.z) > 0.499F || std::abs(stripe - std::round(stripe)) < 0.01F) {
      continue;
    }
    const bool opaque = static_cast<int>(std::floor(stripe)) % 2 == 0;
    EXPECT_EQ(items.triangle[i] == 2 || items.triangle[i] == 3, opaque) << at.x;
    ++at_fence;
  }
  EXPECT_GT(at_fence, 300);
}

// ---- choice of the maker ----

TEST(RasterIsFaster, InSmallScenesAndLongerWithFinerHemicubes) {
  EXPECT_TRUE(raster_is_faster(12));
  EXPECT_FALSE(raster_is_faster(100'000));
  EXPECT_FALSE(raster_is_faster(2000, 16));
  EXPECT_TRUE(raster_is_faster(2000, 128));
}

// ---- any number of threads ----

bool same(const ItemBuffer& a, const ItemBuffer& b) {
  return a.triangle == b.triangle && a.barycentrics == b.barycentrics && a.back == b.back;
}

TEST_P(EachMaker, FillsTheSameFromManyThreadsAtOnce) {
  const Scene scene = test::many_boxes(50, 9);
  const Makers makers(scene);
  std::mt19937 random(6);
  std::vector<Viewpoint> viewpoints;
  std::vector<ItemBuffer> expected(40);
  for (ItemBuffer& items : expected) {
    viewpoints.push_back(random_viewpoint(scene, random));
    maker(makers).fill(Hemicube(expected.size() % 3 == 0 ? 16 : 24), viewpoints.back(), items);
  }
  std::vector<ItemBuffer> found(expected.size());
  std::vector<std::thread> threads;
  for (std::size_t thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&, thread] {
      for (std::size_t i = thread; i < found.size(); i += 4) {
        maker(makers).fill(Hemicube(expected.size() % 3 == 0 ? 16 : 24), viewpoints[i], found[i]);
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_TRUE(same(found[i], expected[i])) << i;
  }
}

TEST(RayScene, AnswersAlikeHoweverManyThreadsBuildIt) {
  // Every triangle twice: which of the two a ray meets depends on nothing but the order they were built in.
  Scene scene = test::tessellated(test::many_boxes(100, 12), 4);
  const std::vector<glm::uvec3> once = scene.triangles;
  scene.triangles.insert(scene.triangles.end(), once.begin(), once.end());
  const std::vector<std::uint32_t> surfaces = scene.surface_of_triangle;
  scene.surface_of_triangle.insert(scene.surface_of_triangle.end(), surfaces.begin(), surfaces.end());

  const auto look_around = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const RayScene rays(scene);
    const auto maker = make_item_buffer_rays(rays);
    std::mt19937 random(3);
    std::vector<ItemBuffer> all(20);
    for (ItemBuffer& items : all) {
      maker->fill(Hemicube(32), random_viewpoint(scene, random), items);
    }
    return all;
  };
  const std::vector<ItemBuffer> expected = look_around(1);
  for (const std::size_t threads : {2U, 8U}) {
    const std::vector<ItemBuffer> found = look_around(threads);
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_TRUE(same(found[i], expected[i])) << threads << " threads, viewpoint " << i;
    }
  }
}

}  // namespace
}  // namespace radiosity
