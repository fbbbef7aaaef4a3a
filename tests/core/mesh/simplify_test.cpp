#include "core/mesh/simplify.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>
#include <set>

#include "core/mesh/removed_places.h"
#include "core/parallel.h"
#include "tests/core/mesh/conformity.h"
#include "tests/core/test_meshes.h"

namespace radiosity {
namespace {

constexpr float kAllowed = 0.01F;

using LightAt = std::function<float(const glm::vec3&)>;

float linear(const glm::vec3& at) { return 1.0F + 0.5F * at.x + 0.25F * at.y - 0.125F * at.z; }
float bump(const glm::vec3& at) { return std::exp(-20.0F * glm::dot(at - 0.3F, at - 0.3F)); }

/// White light, 0.01 of which may change; shape may by 1e-4, and there is one value, 0, at each vertex.
Carried carried_by(const RefinedMesh& mesh, const LightAt& light) {
  Carried carried;
  const std::size_t count = mesh.positions.size();
  for (const glm::vec3& position : mesh.positions) carried.light.emplace_back(light(position));
  carried.light_tolerance.assign(count, kAllowed);
  carried.shape_tolerance.assign(count, 1e-4F);
  carried.label.assign(count, 0);
  carried.fixed.assign(count, 0);
  carried.values.assign(count, 0.0F);
  for (std::size_t v = 0; v <= count; ++v) carried.first_value.push_back(v);
  return carried;
}

Simplified simplified(const RefinedMesh& mesh, const Carried& carried) { return simplify(mesh, carried, {}); }

std::set<std::uint32_t> vertices_of(const Simplified& left) {
  std::set<std::uint32_t> vertices;
  for (const glm::uvec3& corners : left.corners) vertices.insert({corners.x, corners.y, corners.z});
  return vertices;
}

RefinedMesh mesh_of(const RefinedMesh& mesh, const Simplified& left) {
  RefinedMesh result = mesh;
  result.elements = left.corners;
  return result;
}

double total_area(const RefinedMesh& mesh) {
  double area = 0.0;
  for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) area += double{element_area(mesh, e)};
  return area;
}

/// Around the origin, of what a closed mesh holds.
double volume(const RefinedMesh& mesh) {
  double sum = 0.0;
  for (const glm::uvec3& corners : mesh.elements) {
    const glm::dvec3 a(mesh.positions[corners.x]), b(mesh.positions[corners.y]), c(mesh.positions[corners.z]);
    sum += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  return sum;
}

/// The six sides of a unit cube, each with vertices of its own.
RefinedMesh cube(int n) {
  RefinedMesh mesh;
  test::add_grid(mesh, n, {0, 0, 0}, {0, 1, 0}, {1, 0, 0});
  test::add_grid(mesh, n, {0, 0, 1}, {1, 0, 0}, {0, 1, 0});
  test::add_grid(mesh, n, {0, 0, 0}, {0, 0, 1}, {0, 1, 0});
  test::add_grid(mesh, n, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  test::add_grid(mesh, n, {0, 0, 0}, {1, 0, 0}, {0, 0, 1});
  test::add_grid(mesh, n, {0, 1, 0}, {0, 0, 1}, {1, 0, 0});
  return mesh;
}

/// Two grids that meet in the line x = 0, each with vertices of its own there.
RefinedMesh two_grids(int n) {
  RefinedMesh mesh;
  test::add_grid(mesh, n, {-1, 0, 0}, {1, 0, 0}, {0, 1, 0});
  test::add_grid(mesh, n, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  return mesh;
}

/// Values that differ from side to side, so that equal positions are not equal vertices.
void tell_apart(const RefinedMesh& mesh, Carried& carried) {
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    carried.values[v] = v < mesh.positions.size() / 2 ? 0.0F : 1000.0F;
  }
}

std::size_t count_at_x_0(const RefinedMesh& mesh, const Simplified& left) {
  const std::set<std::uint32_t> vertices = vertices_of(left);
  return static_cast<std::size_t>(
      std::ranges::count_if(vertices, [&](std::uint32_t v) { return std::abs(mesh.positions[v].x) < 0.1F; }));
}

TEST(Simplify, AFlatSquareUnderLinearLightKeepsItsCorners) {
  const RefinedMesh mesh = test::grid(16);
  const Simplified left = simplified(mesh, carried_by(mesh, linear));
  EXPECT_THAT(vertices_of(left), testing::ElementsAre(0, 16, 16 * 17, 17 * 17 - 1));
  EXPECT_EQ(left.corners.size(), 2U);
  EXPECT_TRUE(std::ranges::is_sorted(left.elements));
  EXPECT_NEAR(total_area(mesh_of(mesh, left)), 1.0, 1e-6);
  EXPECT_LT(left.squared_light_change, 1e-10);
}

TEST(Simplify, LightChangesNowhereByMoreThanIsAllowed) {
  const RefinedMesh mesh = test::grid(32);
  const Carried carried = carried_by(mesh, bump);
  const Simplified left = simplified(mesh, carried);
  EXPECT_LT(vertices_of(left).size(), mesh.positions.size() / 3);
  EXPECT_GT(vertices_of(left).size(), 20U);

  // At every vertex that was, and in the middle of every edge.
  std::vector<Stand> stands;
  for (const glm::uvec3& corners : left.corners) stands.emplace_back(mesh, corners);
  const Deviation deviation(mesh, carried);
  double squares = 0.0;
  for (const glm::uvec3& corners : mesh.elements) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[k], b = corners[(k + 1) % 3];
      for (const Place& place : {Place(a), Place(a, b)}) {
        const Deviation::Found found = deviation.find(place, stands);
        EXPECT_LE(deviation.of(place, stands[found.stand].corners(), found.weights, 2.0F), 1.0F + 1e-4F);
      }
      const Deviation::Found found = deviation.find({a, b}, stands);
      const double change = deviation.of_luminance({a, b}, stands[found.stand].corners(), found.weights);
      squares += change * change / (3.0 * static_cast<double>(mesh.elements.size()));
    }
  }
  EXPECT_NEAR(std::sqrt(left.squared_light_change), std::sqrt(squares), 0.2 * std::sqrt(squares));
}

TEST(Simplify, AClosedBoxKeepsAreaAndVolume) {
  const RefinedMesh mesh = cube(8);
  Carried carried = carried_by(mesh, linear);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    carried.values[v] = 100.0F * static_cast<float>(v / 81);  // six sides
  }
  const Simplified left = simplified(mesh, carried);
  EXPECT_EQ(vertices_of(left).size(), 24U) << "three at each corner";
  EXPECT_EQ(left.corners.size(), 12U);
  EXPECT_NEAR(total_area(mesh_of(mesh, left)), 6.0, 1e-5);
  EXPECT_NEAR(volume(mesh_of(mesh, left)), 1.0, 1e-6);
  EXPECT_EQ(test::t_vertex_count(mesh_of(mesh, left)), 0U);
}

TEST(Simplify, ACreaseStaysWithoutVerticesOfItsOwn) {
  // One surface that is bent: no seam, but no vertex leaves the bend across it.
  RefinedMesh mesh = test::grid(8);
  for (glm::vec3& position : mesh.positions) position.z = 0.5F * std::abs(position.x - 0.5F);
  const Simplified left = simplified(mesh, carried_by(mesh, [](const glm::vec3&) { return 1.0F; }));
  EXPECT_EQ(vertices_of(left).size(), 6U);
  EXPECT_NEAR(total_area(mesh_of(mesh, left)), total_area(mesh), 1e-6);
}

TEST(Simplify, ARoundBorderKeepsEveryVertex) {
  const Scene disc = test::fan(64);
  const RefinedMesh mesh = unrefined(disc);
  const Simplified left = simplified(mesh, carried_by(mesh, linear));
  EXPECT_EQ(vertices_of(left).size(), 64U) << "only the centre goes";
  EXPECT_NEAR(total_area(mesh_of(mesh, left)), total_area(mesh), 1e-5);
}

TEST(Simplify, DriftDoesNotBendABorder) {
  // Each vertex lies next to nothing off the line between its neighbours, all together they are a quarter of a circle.
  RefinedMesh mesh;
  constexpr int kCount = 4000;
  for (int i = 0; i <= kCount; ++i) {
    const float angle = 0.5F * std::numbers::pi_v<float> * static_cast<float>(i) / kCount;
    mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0.0F);
    mesh.positions.emplace_back(0.9F * std::cos(angle), 0.9F * std::sin(angle), 0.0F);
    if (i == 0) continue;
    const auto v = static_cast<std::uint32_t>(2 * i);
    mesh.elements.emplace_back(v - 2, v, v + 1);
    mesh.elements.emplace_back(v - 2, v + 1, v - 1);
  }
  mesh.normals.assign(mesh.positions.size(), {0, 0, 1});
  const Simplified left = simplified(mesh, carried_by(mesh, linear));
  EXPECT_LT(vertices_of(left).size(), 4000U);
  EXPECT_NEAR(total_area(mesh_of(mesh, left)), total_area(mesh), 2e-5);
}

TEST(Simplify, BothSidesOfASeamLoseAVertexTogether) {
  const RefinedMesh mesh = two_grids(8);
  Carried carried = carried_by(mesh, linear);
  tell_apart(mesh, carried);
  const Simplified left = simplified(mesh, carried);
  EXPECT_EQ(vertices_of(left).size(), 8U);
  EXPECT_EQ(count_at_x_0(mesh, left), 4U) << "its ends, on both sides";

  // One side needs the vertex in the middle of the seam.
  carried.light[9 * 4 + 8] *= 2.0F;
  const Simplified more = simplified(mesh, carried);
  EXPECT_TRUE(vertices_of(more).contains(9 * 4 + 8));
  EXPECT_TRUE(vertices_of(more).contains(81 + 9 * 4)) << "the other side";
  EXPECT_EQ(test::t_vertex_count(mesh_of(mesh, more)), 0U);
}

TEST(Simplify, ASeamThatIsNotStraightKeepsEveryVertex) {
  RefinedMesh mesh = two_grids(8);
  for (glm::vec3& position : mesh.positions) {
    if (position.x == 0.0F) position.x = std::fmod(position.y, 0.25F) > 0.0F ? 0.02F : -0.02F;
  }
  Carried carried = carried_by(mesh, linear);
  tell_apart(mesh, carried);
  EXPECT_EQ(count_at_x_0(mesh, simplified(mesh, carried)), 18U);
}

TEST(Simplify, EqualVerticesAreOne) {
  RefinedMesh mesh = test::grid(8), soup;
  for (const glm::uvec3& corners : mesh.elements) {
    for (int k = 0; k < 3; ++k) {
      soup.elements.emplace_back();
      soup.positions.push_back(mesh.positions[corners[k]]);
      soup.normals.push_back(mesh.normals[corners[k]]);
    }
  }
  soup.elements.resize(mesh.elements.size());
  for (std::uint32_t e = 0; e < soup.elements.size(); ++e) soup.elements[e] = glm::uvec3(0, 1, 2) + 3 * e;
  EXPECT_EQ(vertices_of(simplified(soup, carried_by(soup, linear))).size(), 4U);
}

TEST(Simplify, LabelsAndFixedVerticesStay) {
  const RefinedMesh mesh = test::grid(8);
  Carried carried = carried_by(mesh, linear);
  for (std::size_t v = 0; v < carried.label.size(); ++v) carried.label[v] = mesh.positions[v].x < 0.5F ? 1 : 2;
  const std::set<std::uint32_t> left = vertices_of(simplified(mesh, carried));
  for (std::uint32_t row = 0; row < 9; ++row) {
    EXPECT_TRUE(left.contains(9 * row + 3)) << "the last of label 1";
    EXPECT_TRUE(left.contains(9 * row + 4)) << "the first of label 2";
  }
  EXPECT_FALSE(left.contains(9 * 4 + 1));

  carried = carried_by(mesh, linear);
  carried.fixed[40] = 1;
  EXPECT_THAT(vertices_of(simplified(mesh, carried)), testing::ElementsAre(0, 8, 40, 72, 80));
}

TEST(Simplify, ValuesStayLinear) {
  const RefinedMesh mesh = test::grid(8);
  Carried carried = carried_by(mesh, linear);
  for (std::size_t v = 0; v < carried.values.size(); ++v) carried.values[v] = 50.0F * mesh.positions[v].x;
  EXPECT_EQ(vertices_of(simplified(mesh, carried)).size(), 4U);
  carried.values[40] += 1.5F;
  EXPECT_TRUE(vertices_of(simplified(mesh, carried)).contains(40));
  carried.values[40] = std::nanf("");
  EXPECT_TRUE(vertices_of(simplified(mesh, carried)).contains(40)) << "what is no number is not thrown away";
}

TEST(Simplify, NothingTurnsOverOrLosesItsArea) {
  RefinedMesh mesh = test::grid(32);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    mesh.positions[v].z = 0.0002F * static_cast<float>((v * 7919) % 17);  // rough
  }
  Carried carried = carried_by(mesh, bump);
  carried.shape_tolerance.assign(mesh.positions.size(), 0.003F);
  const Simplified left = simplified(mesh, carried);
  EXPECT_LT(left.corners.size(), mesh.elements.size() / 2);
  for (const glm::uvec3& corners : left.corners) {
    const glm::vec3 &a = mesh.positions[corners.x], &b = mesh.positions[corners.y], &c = mesh.positions[corners.z];
    EXPECT_GT(glm::cross(b - a, c - a).z, 1e-6F);
  }
}

TEST(Simplify, LeavesWhatOpenMeshRefusesAndWhatHasNoArea) {
  // A fin on an edge of the grid, and a needle without area beside it.
  RefinedMesh mesh = test::grid(4);
  mesh.positions.insert(mesh.positions.end(), {{0.5F, 0.5F, 1.0F}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}});
  mesh.normals.resize(mesh.positions.size(), {0, 0, 1});
  mesh.elements.emplace_back(12, 13, 25);
  mesh.elements.emplace_back(26, 27, 28);
  const Simplified left = simplified(mesh, carried_by(mesh, linear));
  const std::set<std::uint32_t> vertices = vertices_of(left);
  for (const std::uint32_t v : {12U, 13U, 25U, 26U, 27U, 28U}) EXPECT_TRUE(vertices.contains(v)) << v;
  EXPECT_EQ(std::ranges::count(left.elements, 32U), 1) << "the fin";
  EXPECT_EQ(std::ranges::count(left.elements, 33U), 1) << "the needle";
  EXPECT_EQ(test::t_vertex_count(mesh_of(mesh, left)), test::t_vertex_count(mesh));
}

TEST(Simplify, OneThreadAndFourGiveTheSame) {
  const RefinedMesh mesh = cube(16);
  const Carried carried = carried_by(mesh, bump);
  const Simplified one = on_threads(1, [&] { return simplified(mesh, carried); });
  const Simplified four = on_threads(4, [&] { return simplified(mesh, carried); });
  EXPECT_EQ(one.elements, four.elements);
  EXPECT_EQ(one.corners, four.corners);
  EXPECT_EQ(one.squared_light_change, four.squared_light_change);
}

TEST(Simplify, CanBeCancelled) {
  const RefinedMesh mesh = test::grid(8);
  const Progress progress{nullptr, [] { return true; }};
  EXPECT_THROW(simplify(mesh, carried_by(mesh, linear), progress), Cancelled);
}

}  // namespace
}  // namespace radiosity
