#include "core/mesh/contacts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/core/test_scenes.h"

namespace radiosity {
namespace {

/// A square of two triangles, counter-clockwise.
void add_square(Scene& scene, const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v, bool two_sided) {
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  for (const glm::vec3& at : {corner, corner + u, corner + u + v, corner + v}) {
    scene.positions.push_back(at);
    scene.normals.push_back(glm::normalize(glm::cross(u, v)));
  }
  Surface surface;
  surface.two_sided = two_sided;
  scene.surfaces.push_back(surface);
  for (const glm::uvec3& triangle : {glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)}) {
    scene.triangles.push_back(triangle + first);
    scene.surface_of_triangle.push_back(static_cast<std::uint32_t>(scene.surfaces.size()) - 1);
  }
}

/// A floor of 4 x 4 m about the origin, z up, whose two triangles meet in y = x.
Scene floor_of_four() {
  Scene scene;
  add_square(scene, {-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, false);
  return scene;
}

double total_length(const std::vector<Contact>& contacts) {
  double sum = 0.0;
  for (const Contact& contact : contacts) sum += glm::distance(contact.from, contact.to);
  return sum;
}

TEST(Contacts, AreWhereASheetStands) {
  Scene scene = floor_of_four();
  add_square(scene, {-1, 0.5F, 0}, {2, 0, 0}, {0, 0, 1}, true);
  const std::vector<Contact> contacts = find_contacts(RayScene(scene), {0.2F, {}}, {});
  ASSERT_EQ(contacts.size(), 2U) << "one on each triangle of the floor";
  EXPECT_NEAR(total_length(contacts), 2.0, 1e-3);
  for (const Contact& contact : contacts) {
    EXPECT_LT(contact.triangle, 2U);
    EXPECT_TRUE(contact.shows_both_sides);
    for (const glm::dvec3& end : {contact.from, contact.to}) {
      EXPECT_NEAR(end.y, 0.5, 1e-5);
      EXPECT_NEAR(end.z, 0.0, 1e-5);
    }
  }
}

TEST(Contacts, AreWhereASheetPassesThrough) {
  Scene standing = floor_of_four(), passing = floor_of_four();
  add_square(standing, {-1, 0.5F, 0}, {2, 0, 0}, {0, 0, 1}, true);
  add_square(passing, {-1, 0.5F, -1}, {2, 0, 0}, {0, 0, 2}, true);
  const std::vector<Contact> found = find_contacts(RayScene(passing), {0.2F, {}}, {});
  double on_floor = 0.0;
  for (const Contact& contact : found) {
    if (contact.triangle < 2) on_floor += glm::distance(contact.from, contact.to);
  }
  EXPECT_NEAR(on_floor, total_length(find_contacts(RayScene(standing), {0.2F, {}}, {})), 1e-3);
}

TEST(Contacts, OfPiecesOfOneLineAreJoined) {
  Scene scene = floor_of_four();
  for (int k = 0; k < 8; ++k)
    add_square(scene, {0.5F + 0.1F * static_cast<float>(k), -1.5F, 0}, {0.1F, 0, 0}, {0, 0, 1}, true);
  const std::vector<Contact> contacts = find_contacts(RayScene(scene), {0.2F, {}}, {});
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_NEAR(total_length(contacts), 0.8, 1e-3);
}

/// A closed box of one-sided walls, its bottom on the floor, `width` metres across.
Scene box_on_floor(float width) {
  Scene scene = floor_of_four();
  const float w = width, from = 0.5F;
  add_square(scene, {from, -1.5F, 0}, {w, 0, 0}, {0, 0, 1}, false);
  add_square(scene, {from + w, -1.5F, 0}, {0, 1, 0}, {0, 0, 1}, false);
  add_square(scene, {from + w, -0.5F, 0}, {-w, 0, 0}, {0, 0, 1}, false);
  add_square(scene, {from, -0.5F, 0}, {0, -1, 0}, {0, 0, 1}, false);
  add_square(scene, {from, -1.5F, 1}, {w, 0, 0}, {0, 1, 0}, false);
  return scene;
}

TEST(Contacts, OfABoxWiderThanAPatchDoNotCount) {
  EXPECT_TRUE(find_contacts(RayScene(box_on_floor(1.0F)), {0.2F, {}}, {}).empty());
}

TEST(Contacts, OfAWallThinnerThanAPatchPartWhatIsBeside) {
  const std::vector<Contact> contacts = find_contacts(RayScene(box_on_floor(0.1F)), {0.2F, {}}, {});
  ASSERT_FALSE(contacts.empty());
  for (const Contact& contact : contacts) EXPECT_FALSE(contact.shows_both_sides);
}

TEST(Contacts, AreNotWhereNeighboursMeetAtAnEdge) {
  EXPECT_TRUE(find_contacts(RayScene(test::box_room({1, 2, 3}, Surface{})), {0.2F, {}}, {}).empty());
}

TEST(Contacts, LeaveOutTrianglesWithALevelOfTheirOwn) {
  Scene scene = floor_of_four();
  add_square(scene, {-1, 0.5F, 0}, {2, 0, 0}, {0, 0, 1}, true);
  const std::vector<std::int8_t> levels{2, 2, -1, -1};
  EXPECT_TRUE(find_contacts(RayScene(scene), {0.2F, levels}, {}).empty());
}

}  // namespace
}  // namespace radiosity
