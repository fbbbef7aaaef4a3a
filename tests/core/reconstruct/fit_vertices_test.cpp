#include "core/reconstruct/fit_vertices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numeric>
#include <random>
#include <string>
#include <utility>

#include "tests/core/test_meshes.h"

namespace radiosity {
namespace {

using test::add_grid;
using test::grid;
using test::middle;

using Field = std::function<Rgb(const glm::vec3&)>;
using Chooser = std::function<bool(const glm::vec3&)>;

bool everywhere(const glm::vec3&) { return true; }

/// Samples of a field, `per_element` in each element whose middle is `chosen`.
Samples sample(const RefinedMesh& mesh, const Field& field, int per_element = 3, const Chooser& chosen = everywhere) {
  std::mt19937 generator(1);
  const auto random = [&] { return static_cast<float>(generator() >> 8U) * 0x1p-24F; };
  Samples samples;
  samples.first_of_element.push_back(0);
  for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) {
    const bool is_chosen = chosen(middle(mesh, e));
    for (int k = 0; is_chosen && k < per_element; ++k) {
      glm::vec2 at(random(), random());
      if (at.x + at.y > 1.0F) at = 1.0F - at;
      const glm::vec3 weights(1.0F - at.x - at.y, at.x, at.y);
      glm::vec3 position(0.0F);
      for (int c = 0; c < 3; ++c) position += weights[c] * mesh.positions[mesh.elements[e][c]];
      samples.weights.push_back(weights);
      samples.irradiance.push_back(field(position));
    }
    samples.first_of_element.push_back(static_cast<std::uint32_t>(samples.irradiance.size()));
    samples.buried.push_back(is_chosen ? 0 : 1);
  }
  return samples;
}

/// A grid with its inner vertices moved about and every third quad cut along its other diagonal.
RefinedMesh crooked_grid(int n) {
  RefinedMesh mesh = grid(n);
  std::mt19937 generator(7);
  const auto random = [&] { return static_cast<float>(generator() >> 8U) * 0x1p-24F - 0.5F; };
  for (glm::vec3& p : mesh.positions) {
    const glm::vec2 step = 0.7F / static_cast<float>(n) * glm::vec2(random(), random());
    if (p.x > 0.01F && p.x < 0.99F && p.y > 0.01F && p.y < 0.99F) p += glm::vec3(step, 0.0F);
  }
  for (std::size_t e = 0; e + 1 < mesh.elements.size(); e += 6) {
    const glm::uvec3 a = mesh.elements[e], b = mesh.elements[e + 1];
    mesh.elements[e] = {a.x, a.y, b.z};
    mesh.elements[e + 1] = {a.y, a.z, b.z};
  }
  return mesh;
}

/// Elements 50 times as long as they are wide beside square ones.
RefinedMesh slivers() {
  RefinedMesh mesh;
  add_grid(mesh, 4, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_grid(mesh, 4, {1, 0, 0}, {0.02F, 0, 0}, {0, 1, 0});
  return mesh;
}

std::vector<std::pair<std::string, RefinedMesh>> meshes() {
  RefinedMesh far_off;
  add_grid(far_off, 5, {100, -3, 7}, {0.3F, 0.1F, 0}, {0, 0.2F, 0.9F});
  return {{"grid", grid(8)}, {"crooked", crooked_grid(8)}, {"slivers", slivers()}, {"far off", far_off}};
}

/// The fitted light at each sample, over the area: what the samples say should be its mean.
struct Means {
  glm::dvec3 fitted{0.0}, sampled{0.0};
};

Means means(const RefinedMesh& mesh, const Samples& samples, const std::vector<Rgb>& irradiance) {
  Means means;
  for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) {
    const std::uint32_t first = samples.first_of_element[e], last = samples.first_of_element[e + 1];
    for (std::uint32_t s = first; s < last; ++s) {
      const double weight = double{element_area(mesh, e)} / (last - first);
      means.sampled += weight * glm::dvec3(samples.irradiance[s]);
      for (int k = 0; k < 3; ++k) {
        means.fitted += weight * double{samples.weights[s][k]} * glm::dvec3(irradiance[mesh.elements[e][k]]);
      }
    }
  }
  return means;
}

TEST(FitVertices, ReproducesConstantLight) {
  const Rgb constant(0.1F, 20.0F, 3e5F);
  for (const auto& [name, mesh] : meshes()) {
    for (const int per_element : {1, 3, 7}) {
      const auto samples = sample(
          mesh, [&](const glm::vec3&) { return constant; }, per_element);
      for (const Rgb& value : fit_vertices(mesh, samples, {})) {
        for (int band = 0; band < 3; ++band) EXPECT_NEAR(value[band] / constant[band], 1.0F, 1e-5F) << name;
      }
    }
  }
}

// A slope costs smoothness: what is lost goes with the damping. Inside, the differences along the edges of a regular
// grid balance, and only the border is pulled inwards.
TEST(FitVertices, ReproducesALinearField) {
  const auto field = [](const glm::vec3& p) { return Rgb(2.0F + p.x, 5.0F - 3.0F * p.y, 1.0F + p.x + p.y); };
  const Rgb range(1.0F, 3.0F, 2.0F);
  for (const auto& [name, mesh] :
       {std::pair<std::string, RefinedMesh>("grid", grid(8)), {"crooked", crooked_grid(8)}}) {
    for (const auto& [damping, tolerance] : {std::pair(1e-6, 1e-4F), {0.02, 0.045F}}) {
      const std::vector<Rgb> result = fit_vertices(mesh, sample(mesh, field), {.damping = damping});
      for (std::size_t v = 0; v < result.size(); ++v) {
        const Rgb off = glm::abs(result[v] - field(mesh.positions[v])) / range;
        for (int band = 0; band < 3; ++band) EXPECT_LT(off[band], tolerance) << name << ' ' << damping << ' ' << v;
      }
    }
  }
}

TEST(FitVertices, IsCloserToTheSamplesThanTheirMeans) {
  // A bend, sampled often: the best fit lies above and below it, a mean of the elements around cuts the corner off.
  const RefinedMesh mesh = grid(6);
  const auto field = [](const glm::vec3& p) { return Rgb(std::abs(p.x - 0.5F)); };
  const std::vector<Rgb> fitted = fit_vertices(mesh, sample(mesh, field, 16), {});
  for (std::size_t v = 0; v < fitted.size(); ++v) {
    EXPECT_NEAR(fitted[v].x, field(mesh.positions[v]).x, 0.03F) << v;  // the mesh has an edge in the bend
  }
}

TEST(FitVertices, KeepsTheMeanOfTheSamples) {
  const auto field = [](const glm::vec3& p) {
    return Rgb(p.x > 0.4F ? 10.0F : 4.0F, 0.5F + p.y * p.y, 9.0F + std::sin(3.0F * p.x * p.y));
  };
  for (const auto& [name, mesh] : meshes()) {
    const Samples samples = sample(mesh, field);
    const Means found = means(mesh, samples, fit_vertices(mesh, samples, {}));
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(found.fitted[band] / found.sampled[band], 1.0, 1e-4) << name;
  }
}

TEST(FitVertices, IsNeverNegativeAndStillNearlyKeepsTheMean) {
  // Light that ends in a line: a fit alone would undershoot beside it.
  const auto field = [](const glm::vec3& p) { return Rgb(p.x > 0.63F ? 100.0F : 0.0F); };
  for (const auto& [name, mesh] : meshes()) {
    if (name == "far off") continue;
    const Samples samples = sample(mesh, field, 8);
    const std::vector<Rgb> result = fit_vertices(mesh, samples, {});
    for (const Rgb& value : result) EXPECT_GE(value.x, 0.0F) << name;
    const Means found = means(mesh, samples, result);
    EXPECT_NEAR(found.fitted.x / found.sampled.x, 1.0, 0.03) << name;  // the share that would be negative
  }
}

TEST(FitVertices, StaysNearTheRangeOfAStep) {
  // Least squares overshoot at a step, by a sixth of its height on a line.
  const auto field = [](const glm::vec3& p) { return Rgb(p.x + p.y > 1.1F ? 10.0F : 5.0F); };
  for (const auto& [name, mesh] :
       {std::pair<std::string, RefinedMesh>("grid", grid(8)), {"crooked", crooked_grid(8)}}) {
    const std::vector<Rgb> result = fit_vertices(mesh, sample(mesh, field, 8), {});
    for (std::size_t v = 0; v < result.size(); ++v) {
      EXPECT_GE(result[v].x, 5.0F - 2.0F) << name;
      EXPECT_LE(result[v].x, 10.0F + 2.0F) << name;
      // Three elements from the step nothing is left of it.
      const float apart = (mesh.positions[v].x + mesh.positions[v].y - 1.1F) / std::sqrt(2.0F);
      if (std::abs(apart) > 3.0F / 8.0F) {
        EXPECT_NEAR(result[v].x, apart > 0.0F ? 10.0F : 5.0F, 0.2F) << name;
      }
    }
  }
}

TEST(FitVertices, KeepsTheSidesOfACreaseApart) {
  // A floor and a wall that meet in the x axis, each with vertices of its own.
  RefinedMesh mesh;
  add_grid(mesh, 4, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const std::size_t first_of_wall = mesh.positions.size();
  add_grid(mesh, 4, {0, 0, 0}, {0, 0, 1}, {1, 0, 0});
  Samples samples = sample(mesh, [](const glm::vec3& p) { return Rgb(p.z > 0.0F ? 5.0F : 1.0F); });
  const std::vector<Rgb> result = fit_vertices(mesh, samples, {});
  for (std::size_t v = 0; v < result.size(); ++v) EXPECT_NEAR(result[v].x, v < first_of_wall ? 1.0F : 5.0F, 1e-4F);
}

TEST(FitVertices, SharesLightAcrossASeam) {
  // Two halves of a plane with separate vertices where they meet: fitted as if they were shared.
  RefinedMesh mesh;
  add_grid(mesh, 4, {-1, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const std::size_t first_of_right = mesh.positions.size();
  add_grid(mesh, 4, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  RefinedMesh joined = mesh;
  for (glm::uvec3& element : joined.elements) {
    for (int k = 0; k < 3; ++k) {
      const auto same = std::find(mesh.positions.begin(), mesh.positions.end(), mesh.positions[element[k]]);
      element[k] = static_cast<std::uint32_t>(same - mesh.positions.begin());
    }
  }
  const Samples samples =
      sample(mesh, [](const glm::vec3& p) { return Rgb(p.x > 0.0F ? 5.0F : 1.0F, 2.0F + p.x, 1.0F); });
  const std::vector<Rgb> result = fit_vertices(mesh, samples, {}), expected = fit_vertices(joined, samples, {});
  int seen = 0;
  for (std::size_t a = 0; a < first_of_right; ++a) {
    EXPECT_NEAR(result[a].x, expected[a].x, 1e-3F);
    for (std::size_t b = first_of_right; b < result.size(); ++b) {
      if (mesh.positions[a] != mesh.positions[b]) continue;
      EXPECT_EQ(result[a], result[b]);
      ++seen;
    }
  }
  EXPECT_EQ(seen, 5);
}

TEST(FitVertices, ContinuesLightWhereThereAreNoSamples) {
  const RefinedMesh mesh = grid(10);
  const auto left = [](const glm::vec3& p) { return p.x < 0.5F; };
  const Samples constant = sample(
      mesh, [](const glm::vec3&) { return Rgb(7.0F); }, 3, left);
  for (const Rgb& value : fit_vertices(mesh, constant, {})) EXPECT_NEAR(value.x, 7.0F, 1e-3F);

  // Smoothness alone decides there: nothing beyond what the border between the two shows.
  const Samples lit_from_above = sample(
      mesh, [](const glm::vec3& p) { return Rgb(3.0F + p.y); }, 3, left);
  const std::vector<Rgb> result = fit_vertices(mesh, lit_from_above, {});
  for (const Rgb& value : result) {
    EXPECT_GT(value.x, 2.95F);
    EXPECT_LT(value.x, 4.05F);
  }
}

TEST(FitVertices, FillsHolesBetweenSamples) {
  const RefinedMesh mesh = grid(9);
  const auto outside = [](const glm::vec3& p) { return std::abs(p.x - 0.5F) > 0.2F || std::abs(p.y - 0.5F) > 0.2F; };
  const auto field = [](const glm::vec3& p) { return Rgb(4.0F + p.x); };
  const std::vector<Rgb> result = fit_vertices(mesh, sample(mesh, field, 3, outside), {});
  for (std::size_t v = 0; v < result.size(); ++v) EXPECT_NEAR(result[v].x, field(mesh.positions[v]).x, 0.05F) << v;
}

TEST(FitVertices, LeavesBlackWhatNothingKnownIsJoinedTo) {
  RefinedMesh mesh = grid(3);
  const std::size_t first_of_other = mesh.positions.size();
  add_grid(mesh, 3, {5, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const Samples samples = sample(
      mesh, [](const glm::vec3&) { return Rgb(7.0F); }, 3, [](const glm::vec3& p) { return p.x < 2.0F; });
  const std::vector<Rgb> result = fit_vertices(mesh, samples, {});
  for (std::size_t v = 0; v < result.size(); ++v) EXPECT_NEAR(result[v].x, v < first_of_other ? 7.0F : 0.0F, 1e-4F);
}

TEST(FitVertices, FitsEachBandByItself) {
  const RefinedMesh mesh = crooked_grid(6);
  const auto wave = [](const glm::vec3& p) { return 1.0F + 0.5F * std::sin(7.0F * p.x + 3.0F * p.y); };
  const auto slope = [](const glm::vec3& p) { return 1e4F * (1.0F + p.y); };
  const std::vector<Rgb> together =
      fit_vertices(mesh, sample(mesh, [&](const glm::vec3& p) { return Rgb(wave(p), slope(p), 0.0F); }), {});
  const std::vector<Rgb> waves = fit_vertices(mesh, sample(mesh, [&](const glm::vec3& p) { return Rgb(wave(p)); }), {});
  const std::vector<Rgb> slopes =
      fit_vertices(mesh, sample(mesh, [&](const glm::vec3& p) { return Rgb(slope(p)); }), {});
  for (std::size_t v = 0; v < together.size(); ++v) {
    EXPECT_NEAR(together[v].x / waves[v].x, 1.0F, 1e-4F);
    EXPECT_NEAR(together[v].y / slopes[v].y, 1.0F, 1e-4F);
    EXPECT_EQ(together[v].z, 0.0F);
  }
}

TEST(FitVertices, CopesWithElementsWithoutArea) {
  RefinedMesh mesh = grid(4);
  mesh.elements.emplace_back(0, 1, 1);
  mesh.elements.emplace_back(0, 0, 0);
  const std::vector<Rgb> result = fit_vertices(mesh, sample(mesh, [](const glm::vec3&) { return Rgb(3.0F); }), {});
  for (const Rgb& value : result) EXPECT_NEAR(value.x, 3.0F, 1e-5F);
}

TEST(FitVertices, AcceptsAnEmptyMesh) {
  EXPECT_TRUE(fit_vertices({}, {.first_of_element = {0}, .weights = {}, .irradiance = {}, .buried = {}}, {}).empty());
}

}  // namespace
}  // namespace radiosity
