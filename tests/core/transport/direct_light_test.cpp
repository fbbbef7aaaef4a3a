#include "core/transport/direct_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numeric>

#include "core/photometry.h"
#include "tests/core/haze.h"
#include "tests/core/prepared_scene.h"
#include "tests/core/test_scenes.h"
#include "tests/core/test_skies.h"

namespace radiosity {
namespace {

using test::PreparedScene;

constexpr glm::vec3 kUp(0.0F, 1.0F, 0.0F);
constexpr SurfacePoint kOrigin{{0, 0, 0}, kUp};

/// Irradiance at unit luminance from a parallel rectangle x by z, one corner straight above at height h. Any textbook
/// on heat transfer: F = (X/sqrt(1+X2) atan(Z/sqrt(1+X2)) + Z/sqrt(1+Z2) atan(X/sqrt(1+Z2))) / (2 pi), X = x/h, Z =
/// z/h.
double corner_irradiance(double x, double z, double h) {
  const double rx = std::hypot(x, h), rz = std::hypot(z, h);
  return 0.5 * (x / rx * std::atan(z / rx) + z / rz * std::atan(x / rz));
}

/// The same from x0..x1, z0..z1.
double rectangle_irradiance(double x0, double x1, double z0, double z1, double h) {
  return corner_irradiance(x1, z1, h) - corner_irradiance(x0, z1, h) - corner_irradiance(x1, z0, h) +
         corner_irradiance(x0, z0, h);
}

/// A quad of two triangles, wound like its corners.
float quad_irradiance(const glm::vec3 (&c)[4], const SurfacePoint& at) {
  const glm::vec3 first[3] = {c[0], c[1], c[2]}, second[3] = {c[0], c[2], c[3]};
  return triangle_irradiance(first, at) + triangle_irradiance(second, at);
}

/// A floor, and above it the black square of the occluder scene, but no lamp.
Scene floor_and_blocker() {
  Scene scene = test::occluder();
  scene.surfaces[2].emission = Rgb(0.0F);
  scene.triangles.resize(4);
  scene.surface_of_triangle.resize(4);
  return scene;
}

SurfacePoint on_floor(float x, float z = 0.0F) { return {{x, 0, z}, kUp}; }

Rgb light_at(const Scene& scene, const SurfacePoint& point, std::uint32_t index = 0) {
  const PreparedScene s(scene, 100);
  return s.direct.at(point, index);
}

TEST(TriangleIrradiance, OfACoaxialSquareIsTheClosedForm) {
  for (const float h : {0.1F, 1.0F, 3.0F}) {
    const glm::vec3 facing_down[4] = {{-0.5F, h, -0.5F}, {0.5F, h, -0.5F}, {0.5F, h, 0.5F}, {-0.5F, h, 0.5F}};
    EXPECT_NEAR(quad_irradiance(facing_down, kOrigin), 4.0 * corner_irradiance(0.5, 0.5, double{h}), 1e-5) << h;
  }
}

TEST(TriangleIrradiance, OfACoaxialDiscIsR2OverR2PlusH2) {
  constexpr int kCorners = 2000;
  for (const auto& [r, h] : {std::pair(1.0F, 1.0F), {0.3F, 2.0F}, {5.0F, 0.5F}}) {
    double sum = 0.0;
    for (int k = 0; k < kCorners; ++k) {
      const float a = 2.0F * kPi * static_cast<float>(k) / kCorners, b = a + 2.0F * kPi / kCorners;
      const glm::vec3 slice[3] = {
          {0, h, 0}, {r * std::cos(a), h, r * std::sin(a)}, {r * std::cos(b), h, r * std::sin(b)}};
      sum += double{triangle_irradiance(slice, kOrigin)};
    }
    EXPECT_NEAR(sum, double{kPi * r * r / (r * r + h * h)}, 1e-4);
  }
}

TEST(TriangleIrradiance, LeavesOutWhatIsBelowTheHorizon) {
  const glm::vec3 whole[4] = {{1, -2, -1}, {1, -2, 1}, {1, 2, 1}, {1, 2, -1}};
  const glm::vec3 upper[4] = {{1, 0, -1}, {1, 0, 1}, {1, 2, 1}, {1, 2, -1}};
  EXPECT_GT(quad_irradiance(upper, kOrigin), 0.1F);
  EXPECT_NEAR(quad_irradiance(whole, kOrigin), quad_irradiance(upper, kOrigin), 1e-6F);
  const glm::vec3 below[3] = {{1, -2, -1}, {1, -2, 1}, {1, -0.001F, 0}};
  EXPECT_EQ(triangle_irradiance(below, kOrigin), 0.0F);
}

TEST(TriangleIrradiance, OfAnEndlessWallIsHalfOfTheView) {
  const glm::vec3 wall[4] = {{1, -1e4F, -1e4F}, {1, -1e4F, 1e4F}, {1, 1e4F, 1e4F}, {1, 1e4F, -1e4F}};
  EXPECT_NEAR(quad_irradiance(wall, kOrigin), 0.5F * kPi, 1e-3F);
}

TEST(TriangleIrradiance, IsNegativeSeenFromTheBack) {
  const glm::vec3 front[3] = {{-0.5F, 1, -0.5F}, {0.5F, 1, -0.5F}, {0, 1, 0.5F}};
  const glm::vec3 back[3] = {front[0], front[2], front[1]};
  EXPECT_GT(triangle_irradiance(front, kOrigin), 0.0F);
  EXPECT_FLOAT_EQ(triangle_irradiance(back, kOrigin), -triangle_irradiance(front, kOrigin));
}

TEST(TriangleIrradiance, IsTheSumOfItsParts) {
  const glm::vec3 c[3] = {{-0.3F, 0.4F, -0.2F}, {1.5F, 0.9F, -0.5F}, {0.2F, -0.3F, 0.9F}};
  for (std::uint32_t n = 2; n <= 5; ++n) {
    double sum = 0.0;
    for (std::uint32_t tile = 0; tile < n * n; ++tile) {
      const SubTriangle part = tile_part(n, tile);
      glm::vec3 corner[3];
      for (int k = 0; k < 3; ++k) {
        corner[k] = c[0] + part.corner[k].x * (c[1] - c[0]) + part.corner[k].y * (c[2] - c[0]);
      }
      sum += double{triangle_irradiance(corner, kOrigin)};
    }
    EXPECT_NEAR(sum, triangle_irradiance(c, kOrigin), 1e-5) << n;
  }
}

TEST(TriangleIrradiance, FarAwayIsThatOfAPoint) {
  const glm::vec3 middle(30.0F, 40.0F, 0.0F);  // 50 m off; towards it the cosine at the floor is 0.8
  const glm::vec3 corner[3] = {middle + glm::vec3(-1, 0, -1), middle + glm::vec3(1, 0, -1),
                               middle + glm::vec3(0, 0, 2)};
  EXPECT_NEAR(triangle_irradiance(corner, kOrigin) / (3.0F * 0.8F * 0.8F / 2500.0F), 1.0F, 0.002F);
}

TEST(PunctualLight, FallsOffWithTheSquareOfDistanceAndTheCosine) {
  Scene scene = floor_and_blocker();
  scene.lights = {{.kind = Light::Kind::kPoint, .position = {0, 3, 0}, .intensity = {5, 10, 20}}};
  const Rgb found = light_at(scene, on_floor(1.9F));
  const float d2 = 1.9F * 1.9F + 9.0F, cosine = 3.0F / std::sqrt(d2);
  EXPECT_NEAR(found.y / (10.0F * cosine / d2), 1.0F, 1e-3F);
  EXPECT_NEAR(found.z / found.x, 4.0F, 1e-5F);
}

TEST(PunctualLight, ThrowsAShadow) {
  Scene scene = floor_and_blocker();
  scene.lights = {{.kind = Light::Kind::kPoint, .position = {0, 3, 0}}};
  EXPECT_EQ(light_at(scene, on_floor(0.7F)), Rgb(0.0F));  // the shadow's edge is at 0.75
  EXPECT_GT(light_at(scene, on_floor(0.8F)).y, 0.0F);
}

TEST(PunctualLight, IsNotStoppedByWhatLiesBehindIt) {
  Scene scene = floor_and_blocker();
  scene.lights = {{.kind = Light::Kind::kPoint, .position = {0, 0.999F, 0}}};
  EXPECT_NEAR(light_at(scene, on_floor(0)).y, 1.0F / (0.999F * 0.999F), 2e-3F);
}

TEST(PunctualLight, DoesNotReachTheOtherSide) {
  Scene scene = floor_and_blocker();
  scene.lights = {{.kind = Light::Kind::kPoint, .position = {0, -1, 0}}};
  EXPECT_EQ(light_at(scene, on_floor(0)), Rgb(0.0F));
}

TEST(PunctualLight, EndsAtItsRangeAsGltfSays) {
  for (const float range : {1.2F, 2.0F, 10.0F}) {
    Scene scene = floor_and_blocker();
    scene.lights = {{.kind = Light::Kind::kPoint, .position = {1.5F, 0.8F, 0}, .range = range}};
    const float expected = std::max(std::min(1.0F - std::pow(0.8F / range, 4.0F), 1.0F), 0.0F) / 0.64F;
    EXPECT_NEAR(light_at(scene, on_floor(1.5F)).y, expected, 2e-3F) << range;
  }
  Scene scene = floor_and_blocker();
  scene.lights = {{.kind = Light::Kind::kPoint, .position = {1.5F, 0.8F, 0}, .range = 0.8F}};
  EXPECT_LT(light_at(scene, on_floor(1.5F)).y, 1e-3F);
  EXPECT_EQ(light_at(scene, on_floor(1.9F)).y, 0.0F);
}

TEST(SpotLight, FallsOffBetweenItsConesAsGltfSays) {
  const float inner = glm::radians(20.0F), outer = glm::radians(40.0F);
  Scene scene = floor_and_blocker();
  scene.triangles.resize(2);
  scene.surface_of_triangle.resize(2);
  scene.lights = {{.kind = Light::Kind::kSpot,
                   .position = {0, 1, 0},
                   .direction = {0, -1, 0},
                   .intensity = Rgb(7.0F),
                   .inner_cone_cos = std::cos(inner),
                   .outer_cone_cos = std::cos(outer)}};
  const PreparedScene s(scene, 100);
  for (const float degrees : {0.0F, 10.0F, 19.0F, 25.0F, 30.0F, 35.0F, 39.0F, 41.0F, 60.0F}) {
    const float angle = glm::radians(degrees), cosine = std::cos(angle);
    // KHR_lights_punctual, "Inner and Outer Cone Angles": scale and offset as precomputed there.
    const float scale = 1.0F / std::max(0.001F, std::cos(inner) - std::cos(outer));
    const float cone = std::clamp(cosine * scale - std::cos(outer) * scale, 0.0F, 1.0F);
    const float expected = 7.0F * cone * cone * cosine * cosine * cosine;
    EXPECT_NEAR(s.direct.at(on_floor(std::tan(angle)), 0).y, expected, 5e-3F) << degrees;
  }
}

TEST(DirectionalLight, BringsItsLuxTimesTheCosine) {
  Scene scene = floor_and_blocker();
  scene.lights = {{.kind = Light::Kind::kDirectional, .direction = {0.6F, -0.8F, 0.0F}, .intensity = Rgb(100.0F)}};
  const PreparedScene s(scene, 100);
  EXPECT_NEAR(s.direct.at(on_floor(-1.5F), 0).y, 80.0F, 1e-3F);
  EXPECT_EQ(s.direct.at(on_floor(0.75F), 0).y, 0.0F);  // the blocker's shadow is 0.75 m off its foot
}

// Distant groups of tiles are weighed by an estimate: rays deal out their light unevenly by half a per cent.
TEST(LampLight, UnoccludedIsTheClosedForm) {
  const PreparedScene s(test::parallel_squares(1.0F), 200);
  for (const auto& [x, y] : {std::pair(0.5F, 0.5F), {0.1F, 0.9F}, {0.0F, 0.0F}}) {
    const double expected = rectangle_irradiance(double{-x}, 1.0 - double{x}, double{-y}, 1.0 - double{y}, 1.0);
    EXPECT_NEAR(double{s.direct.at({{x, y, 1}, {0, 0, -1}}, 0).y} / expected, 1.0, 0.01) << x << ", " << y;
  }
}

TEST(LampLight, CountsAsAPointOnlyWhereThatIsHalfAPercentWrongAtMost) {
  // Patches so large that the lamp is two tiles; points on both sides of where it becomes a point (6 edge lengths).
  for (const float distance : {7.0F, 8.0F, 8.6F, 9.0F, 20.0F}) {
    const PreparedScene s(test::parallel_squares(distance), 2);
    ASSERT_EQ(s.patches.lamps.size(), 2U);
    const double expected = rectangle_irradiance(-0.5, 0.5, -0.5, 0.5, double{distance});
    EXPECT_NEAR(double{s.direct.at({{0.5F, 0.5F, distance}, {0, 0, -1}}, 0).y} / expected, 1.0, 0.005) << distance;
  }
}

TEST(LampLight, DoesNotLightWhatIsBehindALampOfOneSide) {
  const PreparedScene s(test::parallel_squares(1.0F), 200);
  EXPECT_EQ(s.direct.at({{0.5F, 0.5F, -1}, {0, 0, 1}}, 0), Rgb(0.0F));
}

TEST(LampLight, LeavesBothSidesOfATwoSidedLamp) {
  Scene scene = test::parallel_squares(1.0F);
  scene.surfaces[0].two_sided = true;
  const PreparedScene s(scene, 200);
  const float front = s.direct.at({{0.5F, 0.5F, 1}, {0, 0, -1}}, 0).y;
  EXPECT_NEAR(front, 4.0 * corner_irradiance(0.5, 0.5, 1.0), 2e-3);
  EXPECT_NEAR(s.direct.at({{0.5F, 0.5F, -1}, {0, 0, 1}}, 0).y, front, 1e-5F);
}

// Turned any way, the points of a lamp lie a rounding error above or below their own tile, which then fills their view.
TEST(LampLight, DoesNotLightItself) {
  for (const bool two_sided : {false, true}) {
    for (int turn = 0; turn < 50; ++turn) {
      const float angle = 0.123F * static_cast<float>(turn), tilt = 0.0777F * static_cast<float>(turn);
      Scene scene = test::parallel_squares(1.0F);
      scene.triangles.resize(2);
      scene.surface_of_triangle.resize(2);
      scene.surfaces[0].two_sided = two_sided;
      for (glm::vec3& p : scene.positions) {
        p = glm::vec3(std::cos(angle) * p.x - std::sin(angle) * p.y, std::sin(angle) * p.x + std::cos(angle) * p.y,
                      p.z);
        p = glm::vec3(p.x, std::cos(tilt) * p.y - std::sin(tilt) * p.z, std::sin(tilt) * p.y + std::cos(tilt) * p.z);
      }
      const PreparedScene s(scene, 50);
      for (const SurfacePoint& point : s.patches.points) {
        EXPECT_LT(s.direct.at(point, 0).y, 1e-3F) << (two_sided ? "two sides, turn " : "one side, turn ") << turn;
        const SurfacePoint tilted{point.position, glm::normalize(point.normal + glm::vec3(0.1F, 0.2F, 0.05F))};
        EXPECT_LT(s.direct.at(tilted, 0).y, 1e-3F) << (two_sided ? "two sides, turn " : "one side, turn ") << turn;
      }
    }
  }
}

TEST(LampLight, IsDarkInTheUmbraAndWholeOutsideThePenumbra) {
  const PreparedScene s(test::occluder(), 200);
  for (std::uint32_t index = 0; index < 20; ++index) {
    EXPECT_EQ(s.direct.at(on_floor(0.7F, 0.3F), index), Rgb(0.0F));
    const double expected = 100.0 * rectangle_irradiance(-1.3 - 0.25, -1.3 + 0.25, -0.25, 0.25, 2.0);
    EXPECT_NEAR(double{s.direct.at(on_floor(1.3F), index).y} / expected, 1.0, 0.01);
  }
}

// From (x, 0, 0) the blocker hides the lamp where its x is below 1 - x. Errors relative to the whole lamp; their bias
// comes from giving every part of a tile the same weight, so it goes with the size of the tiles (8 here).
TEST(LampLight, InThePenumbraIsThatOfTheVisiblePart) {
  const PreparedScene s(test::occluder(), 200);
  double bias = 0.0, square = 0.0;
  int count = 0;
  for (double x = 0.77; x < 1.24; x += 0.02) {
    const double visible = 100.0 * rectangle_irradiance(1.0 - x - x, 0.25 - x, -0.25, 0.25, 2.0);
    const double whole = 100.0 * rectangle_irradiance(-0.25 - x, 0.25 - x, -0.25, 0.25, 2.0);
    for (std::uint32_t index = 0; index < 100; ++index, ++count) {
      const double error = (double{s.direct.at(on_floor(static_cast<float>(x)), index).y} - visible) / whole;
      bias += error;
      square += error * error;
    }
  }
  EXPECT_NEAR(bias / count, 0.0, 0.008);
  EXPECT_LT(std::sqrt(square / count), 0.02);
}

// A little more than half: what is visible is the nearer part.
TEST(LampLight, HalfHiddenIsAboutHalf) {
  const PreparedScene s(test::occluder(), 200);
  double mean = 0.0;
  for (std::uint32_t index = 0; index < 100; ++index) mean += double{s.direct.at(on_floor(1.0F), index).y} / 100.0;
  EXPECT_NEAR(mean / (100.0 * rectangle_irradiance(-1.25, -0.75, -0.25, 0.25, 2.0)), 0.55, 0.02);
}

/// The occluder scene with its lamp cut in a red half at negative x and a green one at positive x.
Scene two_colours() {
  Scene scene = test::occluder();
  const auto lamp_first = scene.triangles[4];
  glm::vec3 low(1e9F), high(-1e9F);
  for (const std::uint32_t v : {lamp_first.x, lamp_first.y, lamp_first.z}) {
    low = glm::min(low, scene.positions[v]);
    high = glm::max(high, scene.positions[v]);
  }
  scene.triangles.resize(4);
  scene.surface_of_triangle.resize(4);
  scene.surfaces[2].emission = {100, 0, 0};
  scene.surfaces.push_back({.reflectance = Rgb(0.0F), .emission = {0, 100, 0}});
  for (const bool right : {false, true}) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    const float x0 = right ? 0.0F : low.x, x1 = right ? high.x : 0.0F;
    for (const glm::vec3 p : {glm::vec3(x0, 2, low.z), {x1, 2, low.z}, {x1, 2, high.z}, {x0, 2, high.z}}) {
      scene.positions.push_back(p);
      scene.normals.push_back(-kUp);
    }
    scene.triangles.emplace_back(first, first + 1, first + 2);
    scene.triangles.emplace_back(first, first + 2, first + 3);
    scene.surface_of_triangle.insert(scene.surface_of_triangle.end(), 2, right ? 3U : 2U);
  }
  return scene;
}

TEST(LampLight, HasTheColoursOfItsLamps) {
  const PreparedScene s(two_colours(), 200);
  Rgb mean(0.0F);
  for (std::uint32_t index = 0; index < 1000; ++index) mean += s.direct.at(on_floor(1.5F), index) / 1000.0F;
  EXPECT_NEAR(double{mean.x} / (100.0 * rectangle_irradiance(-1.75, -1.5, -0.25, 0.25, 2.0)), 1.0, 0.005);
  EXPECT_NEAR(double{mean.y} / (100.0 * rectangle_irradiance(-1.5, -1.25, -0.25, 0.25, 2.0)), 1.0, 0.005);
  EXPECT_EQ(mean.z, 0.0F);
}

TEST(LampLight, HasTheColourOfTheLampThatIsNotHidden) {
  const PreparedScene s(two_colours(), 200);
  Rgb mean(0.0F);
  for (std::uint32_t index = 0; index < 100; ++index) mean += s.direct.at(on_floor(1.0F), index) / 100.0F;
  EXPECT_NEAR(double{mean.y} / (100.0 * rectangle_irradiance(-1.0, -0.75, -0.25, 0.25, 2.0)), 1.0, 0.03);
  EXPECT_LT(mean.x, 0.03F * mean.y);
}

TEST(LampLight, PassesHalfOfAFence) {
  const test::DetailedScene fence = test::see_through_fence();
  const PreparedScene s(fence.scene, 200);
  double mean = 0.0;
  for (std::uint32_t index = 0; index < 100; ++index) {
    mean += double{s.direct.at(on_floor(0.003F * static_cast<float>(index)), index).y} / 100.0;
  }
  EXPECT_NEAR(mean / (400.0 * corner_irradiance(0.25, 0.25, 2.0)), 0.5, 0.05);
}

TEST(DirectLight, IsTheSumOfLampsAndLights) {
  Scene scene = test::occluder();
  scene.lights = {{.kind = Light::Kind::kPoint, .position = {1.3F, 1, 0}, .intensity = Rgb(2.0F)}};
  const PreparedScene both(scene, 200), lamp(test::occluder(), 200);
  EXPECT_NEAR(both.direct.at(on_floor(1.3F), 0).y, lamp.direct.at(on_floor(1.3F), 0).y + 2.0F, 1e-3F);
}

TEST(DirectLight, OfPatchesIsTheMeanOverTheirPoints) {
  const PreparedScene s(test::cornell_box(), 100);
  const std::vector<Rgb> direct = direct_on_patches(s.direct, s.patches, {});
  ASSERT_EQ(direct.size(), s.patches.patch_count());
  for (std::uint32_t p = 0; p < s.patches.patch_count(); ++p) {
    const auto points = s.patches.points_of(p);
    Rgb sum(0.0F);
    for (std::uint32_t k = 0; k < points.size(); ++k) {
      sum += s.direct.at(points[k], p * static_cast<std::uint32_t>(points.size()) + k);
    }
    EXPECT_EQ(direct[p], sum / static_cast<float>(points.size()));
  }
}

TEST(DirectLight, StopsWhenCancelled) {
  const PreparedScene s(test::cornell_box(), 100);
  const Progress cancelled{.report = {}, .cancelled = [] { return true; }};
  EXPECT_THROW(direct_on_patches(s.direct, s.patches, cancelled), Cancelled);
}

/// A floor below a black square of 1 m at y = 1, and a sky that is black but for a sun.
Scene under_a_sun(const glm::vec3& direction, const Rgb& lux) {
  Scene scene = floor_and_blocker();
  scene.sky = test::sky_of(512, [](const glm::vec3&) { return 0.0F; });
  test::add_sun(scene.sky, direction, lux);
  return scene;
}

TEST(DirectLight, OfASunInTheSkyIsItsLuxTimesTheCosine) {
  const glm::vec3 towards = glm::normalize(glm::vec3(1.0F, 1.5F, 0.2F));
  const PreparedScene s(under_a_sun(towards, {100, 50, 25}), 100);
  for (const float x : {-1.9F, 0.5F, 1.9F}) {
    const Rgb light = s.direct.at(on_floor(x), 7);
    for (int band = 0; band < 3; ++band) {
      EXPECT_NEAR(light[band], 100.0F / static_cast<float>(1 << band) * towards.y, 0.5F) << x;
    }
  }
  // The square stands in the way half a metre and more around (-1, 0, -0.2) / 1.5.
  const glm::vec3 shadow = -towards / towards.y;
  EXPECT_EQ(s.direct.at(on_floor(shadow.x, shadow.z), 3), Rgb(0.0F));
  EXPECT_EQ(s.direct.at(on_floor(shadow.x + 0.45F, shadow.z - 0.45F), 3), Rgb(0.0F));
  EXPECT_GT(s.direct.at(on_floor(shadow.x + 0.55F, shadow.z), 3).x, 80.0F);
  EXPECT_EQ(s.direct.at({{-1.9F, 0, 0}, -kUp}, 3), Rgb(0.0F)) << "from behind";
}

TEST(DirectLight, OfABrightPartOfTheSkyHasAPenumbra) {
  // A disc 20 degrees across, overhead. Below the edge of the square half of it is hidden.
  Scene scene = floor_and_blocker();
  scene.sky = test::sky_of(1024, [](const glm::vec3& d) { return d.y > 0.985F ? 1000.0F : 0.0F; });
  const PreparedScene s(scene, 100);
  const float open = s.direct.at(on_floor(1.9F), 0).x;
  double edge = 0.0;
  for (std::uint32_t k = 0; k < 64; ++k) edge += double{s.direct.at(on_floor(0.5F), k).x} / 64.0;
  EXPECT_NEAR(edge / double{open}, 0.5, 0.02);
  EXPECT_EQ(s.direct.at(on_floor(0.1F), 0).x, 0.0F);
  double exact = 0.0;
  for (std::size_t t = 0; t < scene.sky.map.size(); ++t) {
    exact += texel_vector(scene.sky, t).y * double{luminance_of(scene.sky.map[t])};
  }
  EXPECT_NEAR(double{open} / exact, 1.0, 1e-3);
}

TEST(DirectLight, APaneLetsItsShareOfALightThroughAtEveryPoint) {
  const test::Haze detail;
  Scene scene = floor_and_blocker();
  scene.detail = &detail;
  scene.surfaces[scene.surface_of_triangle[2]].see_through = true;
  scene.lights.push_back({.kind = Light::Kind::kDirectional, .direction = -kUp});
  const PreparedScene s(scene, 100);
  for (std::uint32_t index = 0; index < 64; ++index) {
    EXPECT_NEAR(s.direct.at(on_floor(0.1F, -0.05F), index).x, 0.7F, 1.0F / 16.0F) << index;
  }
}

}  // namespace
}  // namespace radiosity
