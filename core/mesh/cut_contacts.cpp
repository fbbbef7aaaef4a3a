#include "core/mesh/cut_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

namespace radiosity {
namespace {

/// A vertex lies on a contact if it is no farther away than this, in surface offsets. The same for all elements,
/// however small they get: what was on a line must not be beside it after a cut, or cuts never end.
constexpr double kOnLine = 8.0;

/// An element is cut through if the contact covers this share of its way through it; an edge is a seam from half.
constexpr double kCutThrough = 0.3, kSeam = 0.5;

/// A contact that covers less of its way through an element does not touch it.
constexpr double kTouches = 1e-6;

/// Where the mesh is refined a cut takes the place of a bisection only from here on.
constexpr double kParted = 0.6;

/// Light jumps where a surface goes on, not where it turns: there a crease keeps it apart.
constexpr double kGoesOnCos = 0.9659258;  // 15 degrees

double least_height(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
  return longest > 0.0 ? glm::length(glm::cross(b - a, c - a)) / longest : 0.0;
}

}  // namespace

/// A contact as a line in its triangle's plane.
struct ContactCutter::Line {
  Line(const Contact& contact, const glm::dvec3& normal)
      : from(contact.from),
        length(glm::distance(contact.from, contact.to)),
        along((contact.to - contact.from) / length),
        across(glm::cross(normal, along)),
        light_jumps(contact.shows_both_sides) {}

  double beside(const glm::dvec3& at) const { return glm::dot(at - from, across); }
  double place(const glm::dvec3& at) const { return glm::dot(at - from, along); }
  /// -1, 0 or 1: right of it, on it, left of it.
  int side(const glm::dvec3& at, double tolerance) const {
    const double distance = beside(at);
    return std::abs(distance) <= tolerance ? 0 : (distance < 0.0 ? -1 : 1);
  }
  /// The share of the stretch between two places that the contact covers.
  double covered(double first, double last) const {
    if (last < first) std::swap(first, last);
    return last > first ? std::max(0.0, std::min(last, length) - std::max(first, 0.0)) / (last - first) : 0.0;
  }

  glm::dvec3 from;
  double length;
  glm::dvec3 along, across;
  bool light_jumps;
};

ContactCutter::ContactCutter(CutMesh& cut, EdgeCopies& edges, const Scene& scene, std::span<const Contact> contacts)
    : cut_(cut), edges_(edges), scene_(scene), tolerance_(kOnLine * double{surface_offset(scene)}) {
  for (const Contact& contact : contacts)
    lines_on_[contact.triangle].emplace_back(contact, normal_of(contact.triangle));
}

ContactCutter::~ContactCutter() = default;

glm::dvec3 ContactCutter::normal_of(std::uint32_t triangle) const {
  return glm::normalize(glm::dvec3(scaled_normal(scene_, triangle)));
}

glm::dvec3 ContactCutter::place_of(std::uint32_t position_class) const {
  return cut_.welder.positions()[position_class];
}

/// Whether an element is as thin as what counts as one line.
bool ContactCutter::is_sliver(const std::array<std::uint32_t, 3>& edges) const {
  const glm::uvec2 one = cut_.bridge.end_classes(edges[0]), other = cut_.bridge.end_classes(edges[1]);
  const std::uint32_t third = other.x == one.x || other.x == one.y ? other.y : other.x;
  return least_height(place_of(one.x), place_of(one.y), place_of(third)) <= tolerance_;
}

/// Whether a cut at `place` of an edge makes no sliver of what is none. A line that cannot leave an element there is
/// crossed by the cuts along others, those are cut along it, and so on towards the edge. What is a sliver already has
/// no say: a chamfer beside a wall must not keep the wall whole.
bool ContactCutter::is_clear(std::span<const std::uint32_t> copies, const glm::dvec3& place) const {
  for (const std::uint32_t copy : copies) {
    for (unsigned int side = 0; side < 2; ++side) {
      const std::uint32_t element = cut_.bridge.element_at(copy, side);
      if (element == kNothing) continue;
      const auto edges = cut_.bridge.edges_of(element);
      if (is_sliver(edges)) continue;
      for (const std::uint32_t edge : edges) {
        const glm::uvec2 ends = cut_.bridge.end_classes(edge);
        if (edge != copy && least_height(place, place_of(ends.x), place_of(ends.y)) <= tolerance_) return false;
      }
    }
  }
  return true;
}

/// An edge of an element that the line of a contact crosses, and where, if the contact covers so much of its way.
std::optional<ContactCutter::Crossing> ContactCutter::crossing_of(const Line& line, std::uint32_t element,
                                                                  double least_covered) const {
  double first = std::numeric_limits<double>::infinity(), last = -first;
  const auto passes = [&](const glm::dvec3& at) {
    first = std::min(first, line.place(at));
    last = std::max(last, line.place(at));
  };
  std::array<Crossing, 2> crossings{};
  std::array<glm::dvec3, 2> place{};
  std::size_t count = 0;
  for (const std::uint32_t edge : cut_.bridge.edges_of(element)) {
    const glm::uvec2 classes = cut_.bridge.end_classes(edge);
    const glm::dvec3 a = place_of(classes.x), b = place_of(classes.y);
    const int side_a = line.side(a, tolerance_), side_b = line.side(b, tolerance_);
    if (side_a == 0) passes(a);
    if (side_b == 0) passes(b);
    if (side_a * side_b >= 0) continue;
    const double at = line.beside(a) / (line.beside(a) - line.beside(b));
    place[count] = a + at * (b - a);
    passes(place[count]);
    crossings[count++] = {edge, static_cast<float>(at), 0.0};
  }
  const double covered = line.covered(first, last);
  if (covered < least_covered) return std::nullopt;
  for (std::size_t k = 0; k < count; ++k) {
    if (!is_clear(edges_.copies_of(crossings[k].edge), place[k])) continue;
    crossings[k].covered = covered;
    return crossings[k];
  }
  return std::nullopt;
}

bool ContactCutter::is_parted(std::uint32_t element) const {
  const auto found = lines_on_.find(cut_.bridge.triangle_of(element));
  if (found == lines_on_.end() || is_sliver(cut_.bridge.edges_of(element))) return false;
  int lines = 0;
  for (const Line& line : found->second) {
    const std::optional<Crossing> crossing = crossing_of(line, element, kTouches);
    if (!crossing) continue;
    if (++lines > 1 || crossing->covered < kParted) return false;
  }
  return lines == 1;
}

/// Whether the surface goes on across an edge.
bool ContactCutter::goes_on(std::uint32_t edge) const {
  const std::uint32_t one = cut_.bridge.triangle_at(edge, 0), other = cut_.bridge.triangle_at(edge, 1);
  if (one == kNothing || other == kNothing) return false;
  return one == other || glm::dot(normal_of(one), normal_of(other)) >= kGoesOnCos;
}

void ContactCutter::mark_seams(std::uint32_t element, std::span<const Line> lines) {
  for (const std::uint32_t edge : cut_.bridge.edges_of(element)) {
    const glm::uvec2 classes = cut_.bridge.end_classes(edge);
    const glm::dvec3 a = place_of(classes.x), b = place_of(classes.y);
    const bool is_seam = std::ranges::any_of(lines, [&](const Line& line) {
      return line.light_jumps && line.side(a, tolerance_) == 0 && line.side(b, tolerance_) == 0 &&
             line.covered(line.place(a), line.place(b)) >= kSeam;
    });
    if (!is_seam) continue;
    ends_on_contacts_.insert({classes.x, classes.y});
    if (goes_on(edge)) cut_.seams.insert(pair_key(classes));
  }
}

std::vector<EdgeCopies::Part> ContactCutter::cut(std::uint32_t element, const MeshLimits& limits) {
  std::vector<EdgeCopies::Part> parts;
  const auto found = lines_on_.find(cut_.bridge.triangle_of(element));
  if (found == lines_on_.end()) return parts;
  std::vector<std::uint32_t> waiting{element};
  std::set<std::uint32_t> pieces{element};
  while (!waiting.empty()) {
    // The next contact that crosses a piece. Slivers are cut for their neighbours' sake only.
    const std::uint32_t piece = waiting.back();
    std::optional<Crossing> crossing;
    const bool may_be_cut = !is_sliver(cut_.bridge.edges_of(piece));
    for (std::size_t k = 0; may_be_cut && !crossing && k < found->second.size(); ++k) {
      crossing = crossing_of(found->second[k], piece, kCutThrough);
    }
    if (!crossing) {
      mark_seams(piece, found->second);
      waiting.pop_back();
      continue;
    }

    // The cut.
    const std::vector<std::uint32_t> copies = edges_.copies_of(crossing->edge);
    if (!edges_.fits(copies, limits)) return parts;
    for (const EdgeCopies::Part& part : edges_.cut(copies, crossing->at)) {
      parts.push_back(part);
      if (!pieces.contains(part.of_element)) continue;
      pieces.insert(part.element);
      waiting.push_back(part.element);
    }
  }
  return parts;
}

/// How many contacts cross the stretch between two places.
int ContactCutter::crossings(std::span<const Line> lines, const glm::uvec2& end_classes) const {
  const glm::dvec3 a = place_of(end_classes.x), b = place_of(end_classes.y);
  return static_cast<int>(std::ranges::count_if(lines, [&](const Line& line) {
    if (line.side(a, tolerance_) * line.side(b, tolerance_) >= 0) return false;
    const double at = line.beside(a) / (line.beside(a) - line.beside(b)), place = line.place(a + at * (b - a));
    return place >= -tolerance_ && place <= line.length + tolerance_;
  }));
}

/// Turns an edge if fewer contacts cross it then, and what comes of it is no sliver.
bool ContactCutter::turn(std::uint32_t edge) {
  const std::uint32_t triangle = cut_.bridge.triangle_at(edge, 0);
  if (triangle == kNothing || cut_.bridge.triangle_at(edge, 1) != triangle) return false;
  const auto found = lines_on_.find(triangle);
  if (found == lines_on_.end()) return false;
  const glm::uvec2 ends = cut_.bridge.end_classes(edge), opposite = cut_.bridge.opposite_classes(edge);
  const int before = crossings(found->second, ends);
  if (before == 0 || crossings(found->second, opposite) >= before || cut_.seams.contains(pair_key(ends))) return false;

  // As a quad it must be convex.
  const glm::dvec3 a = place_of(ends.x), b = place_of(ends.y), l = place_of(opposite.x), r = place_of(opposite.y);
  if (glm::dot(glm::cross(r - l, a - l), glm::cross(r - l, b - l)) >= 0.0) return false;
  return least_height(l, r, a) > tolerance_ && least_height(l, r, b) > tolerance_ && edges_.turn(edge);
}

/// Turns what may be turned; returns the elements beside.
std::vector<std::uint32_t> ContactCutter::turn_edges_off_lines() {
  std::vector<std::uint32_t> beside;
  for (std::uint32_t edge = 0; edge < cut_.bridge.edge_count(); ++edge) {
    if (!turn(edge)) continue;
    for (const unsigned int side : {0U, 1U}) beside.push_back(cut_.bridge.element_at(edge, side));
  }
  return beside;
}

void ContactCutter::cut_all(const MeshLimits& limits) {
  if (lines_on_.empty()) return;
  cut_.bridge.begin_round(0, 0);
  std::vector<std::uint32_t> again;
  std::uint32_t next = 0;
  do {
    for (const std::uint32_t element : again) cut(element, limits);
    for (; next < cut_.bridge.face_count(); ++next) cut(next, limits);
    again = turn_edges_off_lines();
  } while (!again.empty());
  cut_.write_elements();
  split_sides(limits);
}

namespace {

/// Lets the elements around vertices on seams fall apart into sides.
class SideSplitter {
 public:
  /// Elements as thin as `tolerance` (m) are slivers.
  SideSplitter(CutMesh& cut, std::size_t max_vertices, double tolerance)
      : cut_(cut), max_vertices_(max_vertices), tolerance_(tolerance) {}

  /// Also at `others`, position classes where no edge need be a seam.
  void run(const std::unordered_set<std::uint32_t>& others) {
    for (const std::uint64_t key : cut_.seams) {
      corners_at_[static_cast<std::uint32_t>(key >> 32U)];
      corners_at_[static_cast<std::uint32_t>(key)];
    }
    for (const std::uint32_t position_class : others) corners_at_[position_class];
    for (std::uint32_t element = 0; element < cut_.mesh.elements.size(); ++element) list(element);
    for (const auto& [position_class, corners] : corners_at_) split(position_class, corners);
  }

 private:
  struct Corner {
    std::uint32_t element = 0, vertex = 0;
    glm::uvec2 other_classes{0};
    bool in_sliver = false;
  };

  void list(std::uint32_t element) {
    const glm::uvec3& vertices = cut_.mesh.elements[element];
    glm::uvec3 classes;
    for (int k = 0; k < 3; ++k) classes[k] = cut_.welder.class_of(cut_.mesh.positions[vertices[k]]);
    for (int k = 0; k < 3; ++k) {
      const auto found = corners_at_.find(classes[k]);
      if (found == corners_at_.end()) continue;
      found->second.push_back(
          {element, vertices[k], {classes[(k + 1) % 3], classes[(k + 2) % 3]}, is_sliver(vertices)});
    }
  }

  bool is_sliver(const glm::uvec3& element) const {
    const auto& positions = cut_.mesh.positions;
    return least_height(positions[element.x], positions[element.y], positions[element.z]) <= tolerance_;
  }

  glm::vec3 normal_at(const Corner& corner) const {
    const glm::vec3& own = cut_.mesh.normals[corner.vertex];
    if (own != glm::vec3(0.0F)) return own;
    const glm::uvec3& e = cut_.mesh.elements[corner.element];
    const auto& positions = cut_.mesh.positions;
    return glm::normalize(glm::cross(positions[e.y] - positions[e.x], positions[e.z] - positions[e.x]));
  }

  /// Whether two corners would show one light. Across a crease they would not, so none leads around the end of a seam.
  bool agree(const Corner& one, const Corner& other) const {
    return one.vertex == other.vertex || double{glm::dot(normal_at(one), normal_at(other))} >= kGoesOnCos;
  }

  /// Calls visit(i, j) for corners at one edge that is no seam, and would show one light.
  template <typename Visit>
  void for_neighbors(std::uint32_t position_class, std::span<const Corner> corners, const Visit& visit) const {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> corner_at_edge;  // by the class of its other end
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
      for (int k = 0; k < 2; ++k) {
        const std::uint32_t other = corners[i].other_classes[k];
        if (!cut_.seams.contains(pair_key({position_class, other}))) corner_at_edge.emplace_back(other, i);
      }
    }
    std::ranges::sort(corner_at_edge);
    for (std::size_t k = 1; k < corner_at_edge.size(); ++k) {
      for (std::size_t l = k; l-- > 0 && corner_at_edge[l].first == corner_at_edge[k].first;) {
        const std::uint32_t i = corner_at_edge[l].second, j = corner_at_edge[k].second;
        if (agree(corners[i], corners[j])) visit(i, j);
      }
    }
  }

  /// The side of each corner: corners are on one side if elements at edges that are no seams lead from one to another.
  /// Slivers go with a neighbour, but lead nowhere.
  std::vector<std::uint32_t> sides_of(std::uint32_t position_class, std::span<const Corner> corners) const {
    std::vector<std::uint32_t> side(corners.size());
    std::iota(side.begin(), side.end(), 0U);
    for_neighbors(position_class, corners, [&](std::uint32_t i, std::uint32_t j) {
      if (corners[i].in_sliver != corners[j].in_sliver) return;
      const std::uint32_t one = side[i], other = side[j];
      std::ranges::replace(side, std::max(one, other), std::min(one, other));
    });
    std::vector<std::uint32_t> side_of_slivers(corners.size(), kNothing);  // by the one that they have by themselves
    for_neighbors(position_class, corners, [&](std::uint32_t i, std::uint32_t j) {
      if (corners[i].in_sliver == corners[j].in_sliver) return;
      const std::uint32_t sliver = side[corners[i].in_sliver ? i : j], other = side[corners[i].in_sliver ? j : i];
      side_of_slivers[sliver] = std::min(side_of_slivers[sliver], other);
    });
    for (std::uint32_t& s : side) s = side_of_slivers[s] != kNothing ? side_of_slivers[s] : s;
    return side;
  }

  void split(std::uint32_t position_class, std::span<const Corner> corners) {
    const std::vector<std::uint32_t> side = sides_of(position_class, corners);
    if (std::ranges::all_of(side, [&](std::uint32_t s) { return s == side.front(); })) return;

    // The vertex that each corner is to name: its own on the first side that names it, elsewhere a copy.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> vertex_on_side;
    std::map<std::uint32_t, std::uint32_t> number_of_side;
    std::set<std::uint32_t> named;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const bool is_new = vertex_on_side.try_emplace({corners[i].vertex, side[i]}, kNothing).second;
      if (is_new && named.insert(corners[i].vertex).second) {
        vertex_on_side[{corners[i].vertex, side[i]}] = corners[i].vertex;
      }
    }
    if (cut_.mesh.positions.size() + vertex_on_side.size() - named.size() > max_vertices_) return;
    for (auto& [of, vertex] : vertex_on_side) {
      const auto [original, its_side] = of;
      if (vertex == kNothing) vertex = cut_.add_cut({{original, original}, 0.5F}, position_class);
      const auto [number, is_first] = number_of_side.try_emplace(its_side, cut_.side_count + 1);
      if (is_first) ++cut_.side_count;
      cut_.set_side(vertex, number->second);
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t vertex = vertex_on_side.at({corners[i].vertex, side[i]});
      if (vertex != corners[i].vertex) cut_.bridge.rename(corners[i].element, corners[i].vertex, vertex);
    }
  }

  CutMesh& cut_;
  std::size_t max_vertices_;
  double tolerance_;
  std::map<std::uint32_t, std::vector<Corner>> corners_at_;  ///< the position classes of vertices on seams
};

}  // namespace

void ContactCutter::split_sides(const MeshLimits& limits) {
  if (ends_on_contacts_.empty()) return;
  SideSplitter(cut_, limits.max_vertices, tolerance_).run(ends_on_contacts_);
  cut_.write_elements();
}

}  // namespace radiosity
