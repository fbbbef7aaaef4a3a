#include "core/mesh/cut_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <set>
#include <utility>

#include "core/mesh/subdivide_adaptive.h"
#include "core/mesh/subdivide_uniform.h"
#include "core/mesh/t_vertices.h"
#include "core/reconstruct/smooth_groups.h"
#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

/// The floor of a test scene cut to 0.3 m, and contacts on its triangles that no edge lies on.
struct CutFloor {
  explicit CutFloor(std::vector<Contact> contacts_there) : contacts(std::move(contacts_there)) {
    subdivide_uniform(cut, {.patch_size = 0.3F, .level_of_triangle = {}}, {});
    cut.write_elements();
    EdgeCopies edges(cut);
    ContactCutter(cut, edges, scene, contacts).cut_all({.max_vertices = max_vertices});
  }

  Scene scene = test::floor_only();
  CutMesh cut{scene};
  std::vector<Contact> contacts;
  std::size_t max_vertices = 100'000;
};

/// Two triangles, counter-clockwise.
void add_quad(Scene& scene, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  scene.positions.insert(scene.positions.end(), {a, b, c, d});
  scene.normals.insert(scene.normals.end(), 4, glm::normalize(glm::cross(b - a, c - a)));
  for (const glm::uvec3& triangle : {glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)}) {
    scene.triangles.push_back(first + triangle);
    scene.surface_of_triangle.push_back(0);
  }
}

glm::dvec3 corner(const Scene& scene, std::uint32_t triangle, int k) {
  return scene.positions[scene.triangles[triangle][k]];
}

/// A line across a triangle, that far along the edges from its first corner.
Contact line(const Scene& scene, std::uint32_t triangle, double along_first, double along_last) {
  const glm::dvec3 from = glm::mix(corner(scene, triangle, 0), corner(scene, triangle, 1), along_first);
  return {triangle, from, glm::mix(corner(scene, triangle, 0), corner(scene, triangle, 2), along_last), true};
}

/// One from the middle of one edge to a third of the next, or the `share` of it in the middle.
Contact across(const Scene& scene, std::uint32_t triangle, double share = 1.0) {
  const Contact whole = line(scene, triangle, 0.47, 0.31);
  const double rest = 0.5 * (1.0 - share);
  return {triangle, glm::mix(whole.from, whole.to, rest), glm::mix(whole.to, whole.from, rest), true};
}

double area(const RefinedMesh& mesh) {
  double sum = 0.0;
  for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) sum += double{element_area(mesh, e)};
  return sum;
}

/// Whether an element has corners clearly on both sides of a line that it clearly meets.
bool is_crossed(const CutFloor& floor, std::uint32_t element, const Contact& contact) {
  const glm::dvec3 along = glm::normalize(contact.to - contact.from);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(scaled_normal(floor.scene, contact.triangle)));
  const glm::dvec3 beside = glm::cross(normal, along);
  double least = 0.0, most = 0.0;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 at(floor.cut.mesh.positions[floor.cut.mesh.elements[element][k]]);
    least = std::min(least, glm::dot(at - contact.from, beside));
    most = std::max(most, glm::dot(at - contact.from, beside));
  }
  return floor.cut.mesh.triangle_of_element[element] == contact.triangle && least < -0.002 && most > 0.002;
}

TEST(CutContacts, RunAlongEdges) {
  const CutFloor whole({across(test::floor_only(), 0)});
  for (std::uint32_t e = 0; e < whole.cut.mesh.elements.size(); ++e)
    EXPECT_FALSE(is_crossed(whole, e, whole.contacts[0]));
}

TEST(CutContacts, RunAlongEdgesWhereACutBesideAnotherWouldLeaveASliver) {
  // Edges are turned instead: 7 and 14 elements were crossed.
  const Scene scene = test::floor_only();
  for (const auto& [one, other] : {std::pair(line(scene, 0, 0.42, 0.22), line(scene, 0, 0.06, 0.31)),
                                   std::pair(line(scene, 0, 0.21, 0.98), line(scene, 0, 0.01, 0.92))}) {
    const CutFloor floor({one, other});
    for (std::uint32_t e = 0; e < floor.cut.mesh.elements.size(); ++e) {
      EXPECT_FALSE(is_crossed(floor, e, one)) << e;
      EXPECT_FALSE(is_crossed(floor, e, other)) << e;
    }
    const RefinedMesh& mesh = floor.cut.mesh;
    EXPECT_NEAR(area(mesh), area(CutFloor({}).cut.mesh), 1e-5 * area(mesh));
    EXPECT_TRUE(find_t_vertices(mesh.positions, mesh.elements, rounding_tolerance(mesh.positions)).empty());
  }
}

TEST(CutContacts, LeaveTheSurfaceWhole) {
  const CutFloor uncut({}), cut({across(test::floor_only(), 0), across(test::floor_only(), 1, 0.5)});
  EXPECT_GT(cut.cut.mesh.elements.size(), uncut.cut.mesh.elements.size());
  EXPECT_NEAR(area(cut.cut.mesh), area(uncut.cut.mesh), 1e-5 * area(uncut.cut.mesh));
  EXPECT_TRUE(find_t_vertices(cut.cut.mesh.positions, cut.cut.mesh.elements, rounding_tolerance(cut.cut.mesh.positions))
                  .empty());
}

TEST(CutContacts, GiveEachSideItsOwnLight) {
  const CutFloor floor({across(test::floor_only(), 0)});
  const RefinedMesh& mesh = floor.cut.mesh;
  const SmoothGroups groups = find_smooth_groups(mesh);
  std::size_t on_seam = 0;
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    for (std::uint32_t w = 0; w < v; ++w) {
      if (mesh.positions[v] != mesh.positions[w]) continue;
      EXPECT_NE(groups.group_of_vertex[v], groups.group_of_vertex[w]);
      ++on_seam;
    }
  }
  EXPECT_GT(on_seam, 3U);
}

/// How many lights surfaces in the plane z = 0 show at a place, cut along contacts on triangles 0 and 1 at y = 0.45.
std::size_t lights_at(const glm::vec3& place, const Scene& scene) {
  std::vector<Contact> contacts;
  for (const std::uint32_t triangle : {0U, 1U})
    contacts.push_back({triangle, {0.0, 0.45, 0.0}, {1.0, 0.45, 0.0}, true});
  CutMesh cut(scene);
  EdgeCopies edges(cut);
  ContactCutter(cut, edges, scene, contacts).cut_all({});
  const SmoothGroups groups = find_smooth_groups(cut.mesh);
  std::set<std::uint32_t> lights;
  for (std::uint32_t v = 0; v < cut.mesh.positions.size(); ++v) {
    const bool is_there = glm::distance(cut.mesh.positions[v], place) < 1e-6F;
    if (is_there && cut.mesh.normals[v].z > 0.5F) lights.insert(groups.group_of_vertex[v]);
  }
  return lights.size();
}

/// A wall of 1 m that is parted, and whether it shows two lights at the end x = 0 of the contact. `beside` adds what
/// meets it there.
bool is_parted_at_its_end(const std::function<void(Scene&)>& beside) {
  Scene scene;
  scene.surfaces = {{}};
  add_quad(scene, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  beside(scene);
  return lights_at({0, 0.45F, 0}, scene) == 2;
}

TEST(CutContacts, PartLightUpToTheirEnd) {
  EXPECT_TRUE(is_parted_at_its_end([](Scene&) {}));
}

TEST(CutContacts, PartLightAtACreaseThoughWhatIsBehindItIsWhole) {
  EXPECT_TRUE(is_parted_at_its_end([](Scene& scene) {
    add_quad(scene, {0, 0, 0}, {0, 1, 0}, {0, 1, -1}, {0, 0, -1});
  }));
}

TEST(CutContacts, PartLightBesideAChamfer) {
  EXPECT_TRUE(is_parted_at_its_end([](Scene& scene) {
    const float width = 4.0F * surface_offset(scene);
    add_quad(scene, {0, 0, 0}, {0, 1, 0}, {-width, 1, 0}, {-width, 0, 0});
  }));
}

TEST(CutContacts, PartLightWhereSurfacesMeetInAPointOnly) {
  Scene scene;
  scene.surfaces = {{}};
  add_quad(scene, {0, 0.45F, 0}, {1, 0.45F, 0}, {1, 1, 0}, {0, 1, 0});
  add_quad(scene, {-1, 0, 0}, {0, 0, 0}, {0, 0.45F, 0}, {-1, 0.45F, 0});
  EXPECT_EQ(lights_at({0, 0.45F, 0}, scene), 2U);
}

TEST(CutContacts, DoNotPartLightWhereOneSideIsBuried) {
  Contact contact = across(test::floor_only(), 0);
  contact.shows_both_sides = false;
  const CutFloor floor({contact});
  EXPECT_TRUE(floor.cut.seams.empty());
  EXPECT_TRUE(floor.cut.mesh.side_of_seam.empty());
}

TEST(CutContacts, EndWhereCutsLeaveSmallerAndSmallerPieces) {
  const Scene scene = test::cornell_box();
  const RayScene rays(scene);
  CutMesh cut(scene);
  subdivide_uniform(cut, {.patch_size = 0.2F, .level_of_triangle = {}}, {});
  cut.write_elements();
  const std::size_t before = cut.mesh.elements.size();
  const std::vector<Contact> contacts = find_contacts(rays, {0.2F, {}}, {});
  ASSERT_FALSE(contacts.empty());
  EdgeCopies edges(cut);
  ContactCutter(cut, edges, scene, contacts).cut_all({.max_elements = 100'000});
  EXPECT_LT(cut.mesh.elements.size(), 2 * before);
}

TEST(CutContacts, EndWhereALineCannotLeaveThroughAnEdge) {
  // The first line leaves triangle 0 where the corner of triangle 1 is too near for a cut; the others cross what it
  // leaves behind. As one of an arcade's columns had it.
  const glm::vec3 a(-0.024F, 0.139F, 0), b(-0.024F, -0.388F, 0), c(0.077F, -0.648F, 0);
  Scene scene;
  scene.positions = {a, b, c, {}};
  scene.normals.assign(4, {0, 0, 1});
  scene.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.surfaces = {{}};
  scene.surface_of_triangle = {0, 0};
  const glm::vec3 leaves = glm::mix(a, c, 0.024F / 0.101F), beside = glm::normalize(glm::vec3(0.787F, 0.101F, 0));
  scene.positions[3] = leaves + 3.0F * surface_offset(scene) * beside;

  std::vector<Contact> contacts{{0, {0.0, 0.066, 0.0}, {0.0, -2.8, 0.0}, true}};
  for (const double y : {-0.388, 0.071, -0.429}) contacts.push_back({0, {-0.03, y, 0.0}, {0.3, y, 0.0}, true});
  CutMesh cut(scene);
  EdgeCopies edges(cut);
  ContactCutter(cut, edges, scene, contacts).cut_all({.max_elements = 10'000});
  EXPECT_GT(cut.mesh.elements.size(), 4U);
  EXPECT_LT(cut.mesh.elements.size(), 100U);
}

TEST(CutContacts, StayWithinTheVerticesAllowed) {
  for (const std::size_t most : {10U, 20U, 40U}) {
    Scene scene = test::floor_only();
    CutMesh cut(scene);
    EdgeCopies edges(cut);
    const std::vector<Contact> contacts{across(scene, 0), across(scene, 1)};
    ContactCutter cutter(cut, edges, scene, contacts);
    Bisector bisector(cut, edges, {.mesh = {.max_vertices = most}, .level_of_triangle = {}}, &cutter);
    for (int round = 0; round < 20; ++round) {
      std::vector<std::uint32_t> all(cut.mesh.elements.size());
      for (std::uint32_t e = 0; e < all.size(); ++e) all[e] = e;
      bisector.bisect(all);
    }
    EXPECT_LE(cut.mesh.positions.size(), most);
    EXPECT_GE(cut.mesh.positions.size() + 6, most);
  }
}

TEST(CutContacts, StayPartedWhenTheMeshIsRefined) {
  Scene scene = test::floor_only();
  CutMesh cut(scene);
  EdgeCopies edges(cut);
  const std::vector<Contact> contacts{across(scene, 0)};
  ContactCutter cutter(cut, edges, scene, contacts);
  Bisector bisector(cut, edges, {}, &cutter);
  std::size_t seams_before = 0;
  for (int round = 0; round < 6; ++round) {
    std::vector<std::uint32_t> all(cut.mesh.elements.size());
    for (std::uint32_t e = 0; e < all.size(); ++e) all[e] = e;
    bisector.bisect(all);
    EXPECT_GE(cut.seams.size(), seams_before);
    seams_before = cut.seams.size();
  }
  EXPECT_GT(seams_before, 3U);
  EXPECT_TRUE(find_t_vertices(cut.mesh.positions, cut.mesh.elements, rounding_tolerance(cut.mesh.positions)).empty());
}

}  // namespace
}  // namespace radiosity
