// Cuts the mesh along contacts, and lets light jump there.
//
// Edges that a contact crosses are cut where it does, so that it runs along edges from then on. Those are seams: the
// elements around a vertex on one fall apart into sides, each with a vertex of its own at the same place.
//
//        ___________             ___________            The line ends inside an element; it is cut through, but only
//       |\    |    /|           |\   /|\   /|           what the contact covers is a seam.
//       | \   |   / |           | \ / | \ / |
//       |  \  |  /  |    ->     |  \  |  /  |
//       |___\_:_/___|           |___\_|_/___|
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "core/mesh/contacts.h"
#include "core/mesh/cut_mesh.h"
#include "core/mesh/edge_copies.h"

namespace radiosity {

/// Not thread-safe; deterministic.
class ContactCutter {
 public:
  /// `cut`, `edges` and `scene` belong together, and must outlive it.
  ContactCutter(CutMesh& cut, EdgeCopies& edges, const Scene& scene, std::span<const Contact> contacts);
  ~ContactCutter();
  ContactCutter(const ContactCutter&) = delete;
  ContactCutter& operator=(const ContactCutter&) = delete;

  /// Whether one contact crosses an element from side to side, and no other touches it: then a cut does more than a
  /// bisection. Cuts along many lines leave needles that refinement drags on.
  bool is_parted(std::uint32_t element) const;
  /// Cuts an element through along every contact that crosses it, and makes seams of what lies on one; stops before
  /// what exceeds a limit. REQUIRES: a round is open (OpenMeshBridge::begin_round()); split_sides() follows it.
  std::vector<EdgeCopies::Part> cut(std::uint32_t element, const MeshLimits& limits);
  /// Lets the elements around vertices on seams fall apart into sides, as far as there may be more vertices. REQUIRES:
  /// the elements of the mesh are written; they are again in the end.
  void split_sides(const MeshLimits& limits);

  /// Both for all elements, turning edges off contacts in between. They are left in the order of their numbers.
  void cut_all(const MeshLimits& limits);

 private:
  struct Line;
  struct Crossing {
    std::uint32_t edge = kNothing;
    float at = 0.0F;       ///< of the way between its end classes
    double covered = 0.0;  ///< the share of the line's way through the element that the contact covers
  };

  glm::dvec3 normal_of(std::uint32_t triangle) const;
  glm::dvec3 place_of(std::uint32_t position_class) const;
  bool is_sliver(const std::array<std::uint32_t, 3>& edges) const;
  bool is_clear(std::span<const std::uint32_t> copies, const glm::dvec3& place) const;
  std::optional<Crossing> crossing_of(const Line& line, std::uint32_t element, double least_covered) const;
  bool goes_on(std::uint32_t edge) const;
  int crossings(std::span<const Line> lines, const glm::uvec2& end_classes) const;
  bool turn(std::uint32_t edge);
  std::vector<std::uint32_t> turn_edges_off_lines();
  void mark_seams(std::uint32_t element, std::span<const Line> lines);

  CutMesh& cut_;
  EdgeCopies& edges_;
  const Scene& scene_;
  double tolerance_;                                               ///< metres
  std::unordered_map<std::uint32_t, std::vector<Line>> lines_on_;  ///< a triangle
  /// Position classes of edges on contacts: where surfaces meet in a point only, light jumps without a seam.
  std::unordered_set<std::uint32_t> ends_on_contacts_;
};

}  // namespace radiosity
