#include "core/visibility/occlusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <random>

#include "tests/core/haze.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

ShadowRay segment(const glm::vec3& from, const glm::vec3& to, float threshold = 0.0F) {
  const float distance = glm::distance(from, to);
  return {from, (to - from) / distance, distance, threshold};
}

std::vector<std::uint8_t> trace(const Scene& scene, const std::vector<ShadowRay>& rays) {
  const RayScene ray_scene(scene);
  std::vector<std::uint8_t> blocked(rays.size(), 7);
  trace_shadow_rays(ray_scene, rays, blocked);
  return blocked;
}

/// Whether the ray passes through the triangle, by the signs of three volumes; nothing if it passes within rounding of
/// an edge or of an end.
std::optional<bool> crosses(const Scene& scene, std::uint32_t triangle, const ShadowRay& ray) {
  const glm::uvec3& corner = scene.triangles[triangle];
  const glm::dvec3 from(ray.from);
  const glm::dvec3 direction(ray.to_target);
  const glm::dvec3 a = glm::dvec3(scene.positions[corner.x]) - from;
  const glm::dvec3 b = glm::dvec3(scene.positions[corner.y]) - from;
  const glm::dvec3 c = glm::dvec3(scene.positions[corner.z]) - from;
  const glm::dvec3 e(glm::dot(direction, glm::cross(b, c)), glm::dot(direction, glm::cross(c, a)),
                     glm::dot(direction, glm::cross(a, b)));
  const double sum = e.x + e.y + e.z;
  const glm::dvec3 weight = e / sum;
  const double distance = glm::dot(direction, weight.x * a + weight.y * b + weight.z * c);
  const double least = std::min({weight.x, weight.y, weight.z});
  const double margin =
      std::min({std::abs(least), std::abs(distance), std::abs(distance - static_cast<double>(ray.distance))});
  if (margin < 1e-4) {
    return std::nullopt;
  }
  return least > 0.0 && distance > 0.0 && distance < static_cast<double>(ray.distance);
}

std::optional<bool> blocked_by_brute_force(const Scene& scene, const ShadowRay& ray) {
  bool unsure = false;
  for (std::uint32_t triangle = 0; triangle < scene.triangles.size(); ++triangle) {
    const std::optional<bool> crossed = crosses(scene, triangle, ray);
    if (crossed == true) {
      return true;
    }
    unsure = unsure || !crossed;
  }
  return unsure ? std::nullopt : std::optional(false);
}

TEST(Occlusion, AgreesWithBruteForceOnRandomSegments) {
  const Scene scene = test::many_boxes(20, 3);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0.01F, 0.99F);
  std::vector<ShadowRay> rays;
  for (int i = 0; i < 5003; ++i) {
    const glm::vec3 low = scene.positions[0];
    const auto point = [&] {
      return low + glm::vec3(10.0F, 4.0F, 10.0F) * glm::vec3(unit(random), unit(random), unit(random));
    };
    rays.push_back(segment(point(), point()));
  }
  const std::vector<std::uint8_t> blocked = trace(scene, rays);
  int sure = 0;
  int blocked_count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (const std::optional<bool> expected = blocked_by_brute_force(scene, rays[i])) {
      ++sure;
      blocked_count += *expected ? 1 : 0;
      EXPECT_EQ(blocked[i], *expected ? 1 : 0) << i;
    }
  }
  EXPECT_GT(sure, 4900);
  EXPECT_GT(blocked_count, 500);
  EXPECT_LT(blocked_count, 4500);
}

TEST(Occlusion, EndsAtTheTarget) {
  const Scene scene = test::box_room({1.0F, 1.0F, 1.0F}, {});
  const std::vector<std::uint8_t> blocked = trace(scene, {{{0.5F, 0.5F, 0.5F}, {1.0F, 0.0F, 0.0F}, 0.4999F, 0.0F},
                                                          {{0.5F, 0.5F, 0.5F}, {1.0F, 0.0F, 0.0F}, 0.5001F, 0.0F}});
  EXPECT_EQ(blocked, (std::vector<std::uint8_t>{0, 1}));
}

TEST(Occlusion, ReachesLightsAtInfinity) {
  const Scene scene = test::occluder();
  const glm::vec3 up(0.0F, 1.0F, 0.0F);
  const std::vector<std::uint8_t> blocked = trace(scene, {{{0.1F, 0.01F, 0.1F}, up, kInfinity, 0.0F},
                                                          {{1.9F, 0.01F, 0.1F}, up, kInfinity, 0.0F},
                                                          {{0.1F, -0.01F, 0.1F}, -up, kInfinity, 0.0F}});
  EXPECT_EQ(blocked, (std::vector<std::uint8_t>{1, 0, 0}));
}

TEST(Occlusion, BacksOfSurfacesBlockToo) {
  const Scene scene = test::parallel_squares(1.0F);
  const std::vector<std::uint8_t> blocked =
      trace(scene, {segment({0.3F, 0.3F, -1.0F}, {0.3F, 0.3F, 0.5F}), segment({0.3F, 0.3F, 0.5F}, {0.3F, 0.3F, 2.0F})});
  EXPECT_EQ(blocked, (std::vector<std::uint8_t>{1, 1}));
}

TEST(Occlusion, PassesBetweenTheStripesOfAFence) {
  const test::DetailedScene fence = test::see_through_fence();
  std::mt19937 random(8);
  std::uniform_real_distribution<float> across(-0.49F, 0.49F);
  std::vector<ShadowRay> rays;
  std::vector<float> x_at_fence;
  while (rays.size() < 999) {
    const float x = across(random);
    const float into_stripe = std::abs(x / 0.125F - std::round(x / 0.125F));
    if (into_stripe > 0.01F) {
      const glm::vec3 half(0.1F, 0.5F, 0.2F * across(random));
      const glm::vec3 at(x, 1.0F, across(random));
      rays.push_back(segment(at - half, at + half, 0.5F));
      x_at_fence.push_back(x);
    }
  }
  const std::vector<std::uint8_t> blocked = trace(fence.scene, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool opaque = static_cast<int>(std::floor(x_at_fence[i] / 0.125F)) % 2 == 0;
    EXPECT_EQ(blocked[i], opaque ? 1 : 0) << x_at_fence[i];
  }
}

/// A hundred rays with thresholds spread evenly over [0, 1), upwards through whatever lies at the origin's corner.
std::vector<ShadowRay> evenly_thresholded_rays() {
  std::vector<ShadowRay> rays;
  for (int i = 0; i < 100; ++i) {
    rays.push_back(segment({0.3F, 0.4F, -1.0F}, {0.3F, 0.4F, 0.5F}, (static_cast<float>(i) + 0.5F) / 100.0F));
  }
  return rays;
}

TEST(Occlusion, PartlyOpaqueSurfacesBlockTheirShareOfEvenlySpreadThresholds) {
  const test::Haze haze;
  Scene scene = test::parallel_squares(1.0F);
  scene.surfaces[0].see_through = true;
  scene.detail = &haze;
  const std::vector<std::uint8_t> blocked = trace(scene, evenly_thresholded_rays());
  EXPECT_NEAR(static_cast<double>(std::count(blocked.begin(), blocked.end(), 1)), 30.0, 1.0);
}

TEST(Occlusion, SheetsOneBehindAnotherStopDifferentRays) {
  const test::Haze haze;
  Scene scene = test::parallel_squares(1.0F);
  scene.surfaces[0].see_through = true;
  scene.detail = &haze;
  // The same square once more, a little higher.
  const auto vertex_count = static_cast<std::uint32_t>(scene.positions.size());
  for (std::uint32_t v = 0; v < vertex_count; ++v) {
    scene.positions.push_back(scene.positions[v] + glm::vec3(0.0F, 0.0F, 0.125F));
    scene.normals.push_back(scene.normals[v]);
  }
  const std::size_t triangle_count = scene.triangles.size();
  for (std::size_t t = 0; t < triangle_count; ++t) {
    scene.triangles.push_back(scene.triangles[t] + vertex_count);
    scene.surface_of_triangle.push_back(scene.surface_of_triangle[t]);
  }
  const std::vector<std::uint8_t> blocked = trace(scene, evenly_thresholded_rays());
  EXPECT_GT(std::count(blocked.begin(), blocked.end(), 1), 40);  // 51 on the average of all pairs of sheets
}

TEST(Occlusion, NothingBlocksInAnEmptyScene) {
  EXPECT_EQ(trace({}, {segment({0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F})}), std::vector<std::uint8_t>{0});
  EXPECT_TRUE(trace({}, {}).empty());
}

}  // namespace
}  // namespace radiosity
