#include "core/visibility/hemicube.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <random>
#include <set>
#include <tuple>

namespace radiosity {
namespace {

double total(std::span<const float> values) { return std::accumulate(values.begin(), values.end(), 0.0); }

glm::vec3 random_direction(std::mt19937& random) {
  std::normal_distribution<float> normal;
  return glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
}

TEST(Hemicube, DeltaFormFactorsSumToOneAndArePositive) {
  for (const int resolution : {2, 4, 6, 16, 34, 64, 128}) {
    const Hemicube hemicube(resolution);
    EXPECT_EQ(hemicube.cell_count(), 3 * resolution * resolution);
    EXPECT_NEAR(total(hemicube.delta_form_factors()), 1.0, 1e-6) << resolution;
    EXPECT_GT(*std::min_element(hemicube.delta_form_factors().begin(), hemicube.delta_form_factors().end()), 0.0F);
  }
}

TEST(Hemicube, RawDeltaFormFactorsSumToTheKnownValues) {
  const auto raw_sum = [](int resolution) {
    const std::vector<double> raw = raw_delta_form_factors(resolution);
    return std::accumulate(raw.begin(), raw.end(), 0.0);
  };
  EXPECT_NEAR(raw_sum(4), 1.0357, 0.00005);
  EXPECT_NEAR(raw_sum(16), 1.0021, 0.00005);
  EXPECT_NEAR(raw_sum(64), 1.00013, 0.000005);
}

TEST(Hemicube, RawDeltaFormFactorsFollowTheFormulasOfTopAndSide) {
  const int n = 8;
  const Hemicube hemicube(n);
  const std::vector<double> raw = raw_delta_form_factors(n);
  const double area = 4.0 / (n * n);
  const double x = 2.5 * 2.0 / n - 1.0;
  const double y = 6.5 * 2.0 / n - 1.0;
  const double on_top = area / (std::numbers::pi * std::pow(x * x + y * y + 1.0, 2));
  EXPECT_NEAR(raw[6 * n + 2], on_top, 1e-12);

  const double z = 3.5 * 2.0 / n;
  const double on_side = z * area / (std::numbers::pi * std::pow(x * x + z * z + 1.0, 2));
  for (const Hemicube::Face& side : hemicube.faces().last<4>()) {
    EXPECT_NEAR(raw[static_cast<std::size_t>(side.first_cell + 3 * n + 2)], on_side, 1e-12);
  }
}

TEST(Hemicube, FacesLieBehindEachOtherAndCoverEveryCell) {
  const Hemicube hemicube(10);
  int next = 0;
  for (const Hemicube::Face& face : hemicube.faces()) {
    EXPECT_EQ(face.first_cell, next);
    EXPECT_EQ(face.columns, 10);
    next += face.columns * face.rows;
    EXPECT_LT(glm::distance(glm::cross(face.right, face.up), face.axis), 1e-6F);
  }
  EXPECT_EQ(next, hemicube.cell_count());
  const auto axis_of = [&](std::size_t face) { return hemicube.faces()[face].axis; };
  EXPECT_EQ(axis_of(0), glm::vec3(0, 0, 1));
  EXPECT_EQ(axis_of(1), glm::vec3(1, 0, 0));
  EXPECT_EQ(axis_of(2), glm::vec3(-1, 0, 0));
  EXPECT_EQ(axis_of(3), glm::vec3(0, 1, 0));
  EXPECT_EQ(axis_of(4), glm::vec3(0, -1, 0));
}

TEST(Hemicube, DirectionsAreThoseOfTheFacesAndUnitAndAboveTheHorizon) {
  const Hemicube hemicube(14);
  for (const Hemicube::Face& face : hemicube.faces()) {
    for (int row = 0; row < face.rows; ++row) {
      for (int column = 0; column < face.columns; ++column) {
        const auto cell = static_cast<std::size_t>(face.first_cell + row * face.columns + column);
        const float right = (static_cast<float>(column) + 0.5F) * 2.0F / 14.0F - 1.0F;
        const float up = (static_cast<float>(row) + 0.5F) * 2.0F / 14.0F - face.up_start;
        const glm::vec3 expected = glm::normalize(face.axis + right * face.right + up * face.up);
        const glm::vec3 direction = hemicube.directions()[cell];
        EXPECT_LT(glm::distance(direction, expected), 1e-6F) << cell;
        EXPECT_NEAR(glm::length(direction), 1.0F, 1e-6F);
        EXPECT_GT(direction.z, 0.0F);
      }
    }
  }
}

TEST(Hemicube, DirectionsDifferFromCellToCell) {
  const Hemicube hemicube(8);
  std::set<std::tuple<float, float, float>> seen;
  for (const glm::vec3& d : hemicube.directions()) {
    seen.emplace(d.x, d.y, d.z);
  }
  EXPECT_EQ(seen.size(), hemicube.directions().size());
}

TEST(Hemicube, MeanDirectionUnderACosineIsTwoThirdsUp) {
  const Hemicube hemicube(64);
  glm::dvec3 mean(0.0);
  for (std::size_t i = 0; i < hemicube.directions().size(); ++i) {
    mean += static_cast<double>(hemicube.delta_form_factors()[i]) * glm::dvec3(hemicube.directions()[i]);
  }
  EXPECT_NEAR(mean.x, 0.0, 1e-6);
  EXPECT_NEAR(mean.y, 0.0, 1e-6);
  EXPECT_NEAR(mean.z, 2.0 / 3.0, 2e-4);
}

TEST(Frame, IsOrthonormalAndRightHandedForAnyNormal) {
  std::mt19937 random(1);
  std::vector<glm::vec3> normals = {{0, 0, 1},     {0, 0, -1},     {1, 0, 0},          {0, -1, 0},
                                    {0, 0, -0.0F}, {1e-4F, 0, -1}, {-1e-7F, 1e-7F, -1}};
  normals[4] = glm::vec3(0.6F, 0.8F, -0.0F);
  for (int i = 0; i < 1000; ++i) {
    normals.push_back(random_direction(random));
  }
  std::uniform_real_distribution<float> angle(-4.0F, 4.0F);
  for (const glm::vec3& normal : normals) {
    const Viewpoint viewpoint{glm::vec3(0.0F), glm::normalize(normal), angle(random)};
    const Frame axes = frame(viewpoint);
    EXPECT_EQ(axes.w, viewpoint.normal);
    EXPECT_NEAR(glm::length(axes.u), 1.0F, 2e-6F);
    EXPECT_NEAR(glm::length(axes.v), 1.0F, 2e-6F);
    EXPECT_NEAR(glm::dot(axes.u, axes.v), 0.0F, 2e-6F);
    EXPECT_LT(glm::distance(glm::cross(axes.u, axes.v), axes.w), 4e-6F);
  }
}

TEST(Frame, TurnsByTheTwistAboutTheNormal) {
  const Frame still = frame({glm::vec3(0.0F), {0.0F, 0.6F, 0.8F}, 0.0F});
  const Frame turned = frame({glm::vec3(0.0F), {0.0F, 0.6F, 0.8F}, 0.5F});
  EXPECT_NEAR(glm::dot(still.u, turned.u), std::cos(0.5F), 1e-6F);
  EXPECT_NEAR(glm::dot(still.v, turned.u), std::sin(0.5F), 1e-6F);
}

TEST(Twist, StaysWithinAQuarterTurnAndFillsItEvenly) {
  // Sorted, the first 1000 angles leave no gap wider than a few times the mean.
  std::vector<float> angles;
  for (std::uint32_t k = 0; k < 1000; ++k) {
    angles.push_back(low_discrepancy_twist(k));
  }
  std::sort(angles.begin(), angles.end());
  const float quarter = std::numbers::pi_v<float> / 2.0F;
  EXPECT_GE(angles.front(), 0.0F);
  EXPECT_LT(angles.back(), quarter);
  for (std::size_t i = 1; i < angles.size(); ++i) {
    EXPECT_LT(angles[i] - angles[i - 1], 3.0F * quarter / 1000.0F);
  }
}

}  // namespace
}  // namespace radiosity
