#include "core/reconstruct/inherit_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <vector>

#include "core/mesh/subdivide_adaptive.h"
#include "tests/core/reconstruct/gathering.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

using test::Gathering;

glm::vec3 place_of(const RefinedMesh& mesh, const Samples& samples, std::uint32_t e, std::uint32_t s) {
  glm::vec3 place(0.0F);
  for (int k = 0; k < 3; ++k) place += samples.weights[s][k] * mesh.positions[mesh.elements[e][k]];
  return place;
}

/// Some of the floor under a lit occluder, cut twice.
struct Cut {
  Gathering gathering{test::occluder()};
  CutMesh cut{gathering.prepared.scene};
  EdgeCopies edges{cut};
  Bisector bisector{cut, edges, {}};
  Samples before = gather_samples(cut.mesh, gathering.gatherer, {.per_element = 50}, {});
  RefinedMesh mesh_before = cut.mesh;
  std::vector<std::uint32_t> origin = bisector.bisect(std::vector<std::uint32_t>{0, 1});
};

TEST(InheritSamples, KeepsEverySampleWhereItIs) {
  const Cut c;
  const Samples after = inherit_samples(c.before, c.cut.mesh, c.origin);
  ASSERT_EQ(after.sample_count(), c.before.sample_count());
  ASSERT_GT(c.cut.mesh.elements.size(), c.mesh_before.elements.size());

  std::vector<std::uint32_t> next = c.before.first_of_element;
  for (std::uint32_t e = 0; e < c.cut.mesh.elements.size(); ++e) {
    for (std::uint32_t s = after.first_of_element[e]; s < after.first_of_element[e + 1]; ++s) {
      EXPECT_GE(std::min({after.weights[s].x, after.weights[s].y, after.weights[s].z}), 0.0F);
      EXPECT_NEAR(after.weights[s].x + after.weights[s].y + after.weights[s].z, 1.0F, 1e-5F);
      // Among those of the element it comes from.
      const glm::vec3 place = place_of(c.cut.mesh, after, e, s);
      const std::uint32_t from = c.origin[e];
      bool found = false;
      for (std::uint32_t b = c.before.first_of_element[from]; b < c.before.first_of_element[from + 1]; ++b) {
        const bool same_place = glm::distance(place_of(c.mesh_before, c.before, from, b), place) < 1e-4F;
        found = found || (same_place && c.before.irradiance[b] == after.irradiance[s]);
      }
      EXPECT_TRUE(found) << e << ' ' << s;
    }
  }
}

TEST(InheritSamples, PutsNothingIntoAPartWithoutArea) {
  // Cut so close to a corner that its place in the triangle rounds to the corner.
  RefinedMesh mesh;
  mesh.elements = {{0, 1, 3}, {3, 1, 2}};
  mesh.triangle_of_element = {0, 0};
  mesh.part_of_element = {{{{0.0F, 0.0F}, {1.0F, 0.0F}, {0.0F, 0.0F}}}, {{{0.0F, 0.0F}, {1.0F, 0.0F}, {0.0F, 1.0F}}}};
  Samples before;
  before.first_of_element = {0, 2};
  before.at = {{0.25F, 0.25F}, {0.0F, 0.0F}};
  before.weights = {{0.5F, 0.25F, 0.25F}, {1.0F, 0.0F, 0.0F}};
  before.irradiance = {Rgb(1.0F), Rgb(2.0F)};
  before.number = {7, 8};
  before.buried = {0};
  const Samples after = inherit_samples(before, mesh, std::vector<std::uint32_t>{0, 0});
  EXPECT_EQ(after.first_of_element, (std::vector<std::uint32_t>{0, 0, 2}));
  EXPECT_EQ(after.weights, before.weights);
  EXPECT_EQ(after.number, before.number);
}

TEST(InheritSamples, TopsUpOnlyElementsThatWereCut) {
  const Cut c;
  const Samples after =
      samples_after_cuts(c.before, c.cut.mesh, c.origin, c.gathering.gatherer, {.per_element = 80}, {});
  for (std::uint32_t e = 0; e < c.cut.mesh.elements.size(); ++e) {
    const bool is_cut = c.origin[e] != e || std::ranges::count(c.origin, e) > 1;
    const std::uint32_t count = after.first_of_element[e + 1] - after.first_of_element[e];
    if (is_cut) {
      EXPECT_GE(count, 80U) << e;
    } else {
      EXPECT_EQ(count, c.before.first_of_element[e + 1] - c.before.first_of_element[e]) << e;
    }
  }
  EXPECT_EQ(after.taken - c.before.taken, after.sample_count() - c.before.sample_count()) << "nothing is buried here";
}

}  // namespace
}  // namespace radiosity
