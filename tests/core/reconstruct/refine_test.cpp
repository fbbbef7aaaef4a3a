#include "core/reconstruct/refine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <vector>

#include "core/photometry.h"
#include "core/reconstruct/fit_vertices.h"
#include "tests/core/reconstruct/gathering.h"
#include "tests/core/test_meshes.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

using Field = std::function<float(const glm::vec3&)>;

/// A unit square of reflectance 1, as a scene of that many quads and its display mesh: the same.
struct Square {
  Scene scene;
  RefinedMesh mesh;

  explicit Square(int n) : mesh(test::grid(n)) {
    scene.positions = mesh.positions;
    scene.normals = mesh.normals;
    scene.triangles = mesh.elements;
    scene.surface_of_triangle.assign(mesh.elements.size(), 0);
    scene.surfaces = {{.reflectance = Rgb(0.9F)}};
    mesh = unrefined(scene);
  }

  /// Irradiance that shows `field`, at `per_element` places of each element.
  Samples samples(const Field& field, int per_element) const {
    Samples samples;
    samples.first_of_element = {0};
    samples.buried.assign(mesh.elements.size(), 0);
    for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) {
      for (int k = 0; k < per_element; ++k, ++samples.taken) {
        const float x = std::fmod(0.5F + 0.7548777F * static_cast<float>(samples.taken), 1.0F);
        const float y = std::fmod(0.5F + 0.5698403F * static_cast<float>(samples.taken), 1.0F);
        const glm::vec2 at = x + y > 1.0F ? glm::vec2(1.0F - x, 1.0F - y) : glm::vec2(x, y);
        const glm::vec3 weights(1.0F - at.x - at.y, at.x, at.y);
        glm::vec3 place(0.0F);
        for (int c = 0; c < 3; ++c) place += weights[c] * mesh.positions[mesh.elements[e][c]];
        samples.at.push_back(at);
        samples.weights.push_back(weights);
        samples.irradiance.emplace_back(Rgb(field(place) * kPi / 0.9F));
      }
      samples.first_of_element.push_back(samples.taken);
    }
    return samples;
  }

  Misfit misfit(const Samples& samples, const MisfitOptions& options = {}) const {
    return measure_misfit(scene, mesh, samples, fit_vertices(mesh, samples, {}), options);
  }

  /// Root mean square difference of the fit from the field over the field's mean, by many places.
  double true_error(const Samples& samples, const Field& field) const {
    const std::vector<Rgb> light = fit_vertices(mesh, samples, {});
    const Samples places = this->samples(field, 200);
    double squared = 0.0, mean = 0.0;
    for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) {
      for (std::uint32_t s = places.first_of_element[e]; s < places.first_of_element[e + 1]; ++s) {
        float shown = 0.0F;
        for (int c = 0; c < 3; ++c) shown += places.weights[s][c] * light[mesh.elements[e][c]].x;
        const double off = double{shown} - double{places.irradiance[s].x};
        squared += off * off;
        mean += double{places.irradiance[s].x};
      }
    }
    const double count = places.taken;
    return std::sqrt(squared / count) / (mean / count);
  }
};

float constant(const glm::vec3&) { return 0.5F; }
float step(const glm::vec3& p) { return p.x + 0.3F * p.y > 0.63F ? 0.8F : 0.2F; }
float bowl(const glm::vec3& p) { return 0.1F + (p.x - 0.5F) * (p.x - 0.5F) + (p.y - 0.5F) * (p.y - 0.5F); }

TEST(Refine, HasNothingToSayOfConstantLight) {
  const Square square(4);
  const Misfit misfit = square.misfit(square.samples(constant, 3));
  EXPECT_LT(misfit.relative_rmse, 1e-5);
  for (const double one : misfit.of_element) EXPECT_LT(one, 1e-10);
}

TEST(Refine, HasLittleToSayOfALinearLight) {
  const Square square(4);
  const Misfit misfit = square.misfit(square.samples([](const glm::vec3& p) { return 0.2F + 0.5F * p.x; }, 12));
  EXPECT_LT(misfit.relative_rmse, 0.002) << "what smoothness costs";
}

TEST(Refine, RanksElementsAlongAStepFirst) {
  const Square square(16);
  const Misfit misfit = square.misfit(square.samples(step, 12));
  const std::vector<std::uint8_t> all(square.mesh.elements.size(), 1);
  const std::vector<std::uint32_t> worst = worst_elements(misfit, all);
  ASSERT_GE(worst.size(), 512U / 64U);
  ASSERT_LE(worst.size(), 512U / 8U + 1U);
  for (const std::uint32_t e : worst) {
    const glm::vec3 place = test::middle(square.mesh, e);
    EXPECT_LT(std::abs(place.x + 0.3F * place.y - 0.63F), 0.08F);
  }
  for (std::size_t k = 1; k < worst.size(); ++k)
    EXPECT_GE(misfit.of_element[worst[k - 1]], misfit.of_element[worst[k]]);
}

TEST(Refine, RanksNoElementThatMayNotBeCut) {
  const Square square(4);
  const Misfit misfit = square.misfit(square.samples(step, 12));
  std::vector<std::uint8_t> may_be_cut(square.mesh.elements.size(), 0);
  may_be_cut[7] = 1;
  EXPECT_EQ(worst_elements(misfit, may_be_cut), std::vector<std::uint32_t>{7});
}

TEST(Refine, EstimatesTheErrorThatFewSamplesLeave) {
  // Three samples to an element and half a vertex: their own residual is too small by a fifth or more.
  for (const Field& field : {Field(step), Field(bowl)}) {
    for (const int n : {4, 8, 16}) {
      const Square square(n);
      for (const int per_element : {3, 12}) {
        const Samples samples = square.samples(field, per_element);
        const double truth = square.true_error(samples, field);
        const double estimate = square.misfit(samples).relative_rmse;
        EXPECT_GT(estimate, truth / 1.5) << n << ' ' << per_element;
        EXPECT_LT(estimate, truth * 1.5) << n << ' ' << per_element;
      }
    }
  }
}

TEST(Refine, TakesTheNoiseOfSamplesOutOfTheEstimate) {
  // Noise of 10 % on constant light: what is wrong is what the fit keeps of it.
  const Square square(16);
  Samples samples = square.samples(constant, 6);
  for (std::uint32_t s = 0; s < samples.taken; ++s) samples.irradiance[s] *= s * 2654435761U >> 31U ? 1.1F : 0.9F;
  const auto as_constant = [&] {
    const std::vector<Rgb> light = fit_vertices(square.mesh, samples, {});
    double squared = 0.0;
    for (const Rgb& one : light) squared += std::pow(double{one.x} * 0.9 / 3.14159265 / 0.5 - 1.0, 2.0);
    return std::sqrt(squared / static_cast<double>(light.size()));
  }();
  EXPECT_GT(square.misfit(samples).relative_rmse, 0.09);
  const double estimate = square.misfit(samples, {.variance = 0.0025}).relative_rmse;
  EXPECT_LT(estimate, 1.5 * as_constant);
  EXPECT_GT(estimate, as_constant / 2.5) << "vertices are off by more than what lies between them";
}

TEST(Refine, CountsAStepInTheDarkForMoreWhereTheEyeIsAsked) {
  // Two steps of equal height, one in the dark and one in the light.
  const Square square(16);
  const Samples samples = square.samples(
      [](const glm::vec3& p) { return p.x < 0.22F   ? 0.01F
                                      : p.x < 0.47F ? 0.11F
                                      : p.x < 0.78F ? 0.8F
                                                    : 0.9F; }, 12);
  const auto share = [&](ErrorSpace space) {
    const Misfit misfit = square.misfit(samples, {.space = space});
    double dark = 0.0, light = 0.0;
    for (std::uint32_t e = 0; e < square.mesh.elements.size(); ++e) {
      const float x = test::middle(square.mesh, e).x;
      if (x < 0.35F) dark += misfit.of_element[e];
      if (x > 0.65F) light += misfit.of_element[e];
    }
    return dark / light;
  };
  EXPECT_NEAR(share(ErrorSpace::kLinear), 1.0, 0.2);
  EXPECT_GT(share(ErrorSpace::kDisplay), 2.0);
}

TEST(Refine, HidesWhatIsWhite) {
  const Square square(8);
  const Samples samples = square.samples(step, 12);
  const Misfit all_white = square.misfit(samples, {.exposure = 100.0F});
  EXPECT_LT(all_white.relative_rmse, 1e-5) << "0.2 and 0.8 cd/m2 both show as white";
  EXPECT_GT(square.misfit(samples, {.exposure = 1.0F}).relative_rmse, 0.05);
}

TEST(Refine, FindsNoNoiseUnderAPoint) {
  // Punctual lights cast the same light on a place however often it is looked at.
  Scene scene = test::floor_only();
  scene.lights = {{.kind = Light::Kind::kPoint, .position = {0.2F, 1.0F, 0.1F}}};
  const test::Gathering gathering(scene);
  const RefinedMesh mesh = unrefined(gathering.prepared.scene);
  const Samples samples = gathering.samples({.per_element = 20});
  EXPECT_LT(sample_variance(mesh, samples, gathering.gatherer, 50, {}), 1e-10);
}

TEST(Refine, FindsTheNoiseOfALampThatIsPartlyHidden) {
  const test::Gathering gathering(test::occluder());
  const RefinedMesh mesh = unrefined(gathering.prepared.scene);
  const Samples samples = gathering.samples({.per_element = 50});
  EXPECT_GT(sample_variance(mesh, samples, gathering.gatherer, 100, {}), 1e-8);
}

}  // namespace
}  // namespace radiosity
