#include "core/mesh/vertex_moves.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/mesh/t_vertices.h"

namespace radiosity {
namespace {

/// How straight a line must be: as rounding_tolerance() says, with as much more as stitch.cpp grants.
constexpr float kStraightOverRounding = 10.0F;
/// No element turns farther than this in one move.
constexpr double kLeastCos = 0.70710678;
/// How even an element must stay unless one around was worse: 1 is equilateral, this is 20 to 1.
constexpr double kLeastEvenness = 0.05;
/// What the shape of elements weighs against what they show.
constexpr float kCostOfUneven = 0.02F;

/// Along the normal of an element, and how even it is.
struct ElementShape {
  glm::dvec3 normal{0.0};  ///< twice the area long
  double evenness = 0.0;
};

ElementShape shape_of(const RefinedMesh& mesh, const glm::uvec3& corners) {
  const glm::dvec3 a(mesh.positions[corners.x]);
  const glm::dvec3 u = glm::dvec3(mesh.positions[corners.y]) - a, v = glm::dvec3(mesh.positions[corners.z]) - a;
  const glm::dvec3 normal = glm::cross(u, v), w = v - u;
  const double squares = glm::dot(u, u) + glm::dot(v, v) + glm::dot(w, w);
  return {normal, squares > 0.0 ? 2.0 * std::sqrt(3.0) * glm::length(normal) / squares : 0.0};
}

std::vector<std::uint32_t> first_of_each(const Weld& welded) {
  std::vector<std::uint32_t> first(welded.class_count, kNothing);
  for (std::uint32_t v = 0; v < welded.class_of_vertex.size(); ++v) {
    std::uint32_t& known = first[welded.class_of_vertex[v]];
    if (known == kNothing) known = v;
  }
  return first;
}

std::vector<glm::uvec3> with_equal_vertices(const RefinedMesh& mesh, std::span<const std::uint32_t> equal_to) {
  std::vector<glm::uvec3> elements = mesh.elements;
  for (glm::uvec3& corners : elements) corners = {equal_to[corners.x], equal_to[corners.y], equal_to[corners.z]};
  return elements;
}

}  // namespace

//         apex
//        /    \              A fan, clockwise. The element right of a spoke lies left of the next one. Corners start at
//       / left \             the vertex in the middle.
//   vertex ---- spoke
//       \ right/
//        \    /
//         next
struct ShrinkingMesh::Fan {
  std::uint32_t vertex = 0;
  std::vector<CollapseNet::Spoke> spokes;
  std::vector<glm::uvec3> corners;  ///< of the element left of each spoke, if there is one
  std::vector<std::size_t> lines;   ///< spokes that are borders, or whose sides name different vertices
  std::vector<Place> places;        ///< the vertex on each side, and the middles of edges of the mesh as it was

  std::size_t right_of(std::size_t i) const { return i + 1 < spokes.size() ? i + 1 : 0; }
  bool has(std::size_t i) const { return spokes[i].element != kNothing; }

  bool is_line(std::size_t i) const {
    const std::size_t right = right_of(i);
    if (!has(i) || !has(right)) return true;
    return corners[i].x != corners[right].x || corners[i].y != corners[right].z;
  }
};

/// What a move does to the elements around.
struct ShrinkingMesh::Plan {
  /// Elements whose corner at the vertex is `from` get `to` there.
  struct Side {
    std::uint32_t from = kNothing, to = kNothing;
    std::vector<Stand> stands;
    std::vector<std::uint32_t> elements;
  };
  std::vector<Side> sides;  ///< two along a line between two surfaces, otherwise one
  double evenness = 1.0;    ///< of the least even element

  /// REQUIRES: there is one.
  const Side* side_of(std::uint32_t corner) const { return &*std::ranges::find(sides, corner, &Side::from); }
};

ShrinkingMesh::ShrinkingMesh(const RefinedMesh& mesh, const Carried& carried)
    : mesh_(mesh),
      carried_(carried),
      deviation_(mesh, carried),
      welded_(weld(mesh.positions)),
      first_of_class_(first_of_each(welded_)),
      elements_(with_equal_vertices(mesh, find_equal_vertices(welded_.class_of_vertex, carried))),
      net_(mesh.elements, welded_.class_of_vertex, welded_.class_count),
      fixed_(welded_.class_count, 0),
      line_error_(net_.edge_count(), 0.0F),
      is_whole_(net_.edge_count(), 1),
      line_tolerance_(kStraightOverRounding * rounding_tolerance(mesh.positions)),
      removed_(mesh.elements.size()) {
  for (std::uint32_t v = 0; v < fixed_.size(); ++v) fixed_[v] = net_.is_fixed(v) ? 1 : 0;
  for (std::uint32_t v = 0; v < welded_.class_of_vertex.size(); ++v) {
    if (carried.fixed[v] != 0) fixed_[welded_.class_of_vertex[v]] = 1;
  }
  for (std::uint32_t e = 0; e < elements_.size(); ++e) {
    if (element_area(mesh, e) > 0.0F) continue;
    for (int k = 0; k < 3; ++k) fixed_[welded_.class_of_vertex[elements_[e][k]]] = 1;
  }
}

ShrinkingMesh::Fan ShrinkingMesh::fan_of(std::uint32_t vertex) const {
  Fan fan;
  fan.vertex = vertex;
  net_.find_spokes(vertex, fan.spokes);
  fan.corners.resize(fan.spokes.size());
  for (std::size_t i = 0; i < fan.spokes.size(); ++i) {
    if (!fan.has(i)) continue;
    glm::uvec3& corners = fan.corners[i];
    corners = elements_[fan.spokes[i].element];
    while (welded_.class_of_vertex[corners.x] != vertex) corners = {corners.y, corners.z, corners.x};
  }
  for (std::size_t i = 0; i < fan.spokes.size(); ++i) {
    if (fan.is_line(i)) fan.lines.push_back(i);
  }

  // A vertex between two surfaces is a place on each, and so is the middle of a line between them.
  const std::size_t count = fan.spokes.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t right = fan.right_of(i);
    const auto add = [&fan](const Place& place) { fan.places.push_back(place); };
    if (fan.has(i) && std::ranges::find(fan.places, Place(fan.corners[i].x)) == fan.places.end())
      add(Place(fan.corners[i].x));
    if (is_whole_[fan.spokes[i].edge] == 0) continue;
    if (fan.has(i)) add({fan.corners[i].x, fan.corners[i].y});
    if (fan.has(right) && fan.is_line(i)) add({fan.corners[right].x, fan.corners[right].z});
  }
  return fan;
}

double ShrinkingMesh::distance_from_line(std::uint32_t vertex, const glm::uvec2& ends) const {
  const glm::dvec3 from(position(ends.x)), along = glm::dvec3(position(ends.y)) - from,
                                           to_vertex = glm::dvec3(position(vertex)) - from;
  const double at = std::clamp(glm::dot(to_vertex, along) / glm::dot(along, along), 0.0, 1.0);
  return glm::length(to_vertex - at * along);
}

VertexMove ShrinkingMesh::best_move(std::uint32_t vertex, float allowed) const {
  VertexMove best;
  if (fixed_[vertex] != 0) return best;
  const Fan fan = fan_of(vertex);
  if (!fan.lines.empty() && fan.lines.size() != 2) return best;
  for (std::size_t i = 0; i < fan.spokes.size(); ++i) {
    if (fan.has(i) && carried_.label[fan.corners[i].x] != carried_.label[fan.corners[i].y]) return best;
    if (fan.has(i) && carried_.label[fan.corners[i].x] != carried_.label[fan.corners[i].z]) return best;
  }

  // Along a line if it is on one, otherwise anywhere.
  for (std::size_t i = 0; i < fan.spokes.size(); ++i) {
    if (!fan.lines.empty() && !fan.is_line(i)) continue;
    const std::optional<Plan> plan = plan_of(fan, i);
    if (!plan) continue;
    const float uneven = kCostOfUneven * static_cast<float>(1.0 - plan->evenness);
    const float left = (best.to == kNothing ? allowed : best.cost) - uneven;
    const float cost = left > 0.0F ? cost_of(fan, *plan, left) : 1.0F;
    if (cost < left) best = {fan.spokes[i].to, cost + uneven};
  }
  return best;
}

std::optional<ShrinkingMesh::Plan> ShrinkingMesh::plan_of(const Fan& fan, std::size_t along) const {
  // A line must run straight on.
  const std::size_t right = fan.right_of(along);
  if (!fan.lines.empty()) {
    const std::size_t other = fan.lines[fan.lines[0] == along ? 1 : 0];
    const glm::uvec2 ends(fan.spokes[other].to, fan.spokes[along].to);
    const double error = distance_from_line(fan.vertex, ends) +
                         double{std::max(line_error_[fan.spokes[along].edge], line_error_[fan.spokes[other].edge])};
    if (!(error <= double{line_tolerance_})) return std::nullopt;
  }

  // Which vertex becomes which.
  Plan plan;
  if (fan.has(along)) plan.sides.push_back({fan.corners[along].x, fan.corners[along].y, {}, {}});
  if (fan.has(right) && (!fan.has(along) || fan.corners[right].x != fan.corners[along].x)) {
    plan.sides.push_back({fan.corners[right].x, fan.corners[right].z, {}, {}});
  }

  // The elements that stay.
  double worst = kLeastEvenness;
  for (std::size_t i = 0; i < fan.spokes.size(); ++i) {
    if (!fan.has(i)) continue;
    const ElementShape before = shape_of(mesh_, fan.corners[i]);
    worst = std::min(worst, before.evenness);
    if (i == along || i == right) continue;
    const auto side = std::ranges::find(plan.sides, fan.corners[i].x, &Plan::Side::from);
    if (side == plan.sides.end()) return std::nullopt;
    const glm::uvec3 corners(side->to, fan.corners[i].y, fan.corners[i].z);
    const ElementShape after = shape_of(mesh_, corners);
    const double lengths = glm::length(before.normal) * glm::length(after.normal);
    if (!(glm::dot(before.normal, after.normal) > kLeastCos * lengths)) return std::nullopt;
    plan.evenness = std::min(plan.evenness, after.evenness);
    side->stands.emplace_back(mesh_, corners);
    side->elements.push_back(fan.spokes[i].element);
  }
  if (plan.evenness < worst) return std::nullopt;
  for (const Plan::Side& side : plan.sides) {
    if (side.stands.empty()) return std::nullopt;
  }
  return plan;
}

float ShrinkingMesh::cost_of(const Fan& fan, const Plan& plan, float allowed) const {
  float most = 0.0F;
  const auto is_kept = [&](const Place& place, const Plan::Side& side) {
    const Deviation::Found found = deviation_.find(place, side.stands);
    most = std::max(most, deviation_.of(place, side.stands[found.stand].corners(), found.weights, allowed));
    return most <= allowed;
  };

  // What vanishes now, then what vanished before.
  for (const Place& place : fan.places) {
    if (!is_kept(place, *plan.side_of(place.x))) return most;
  }
  for (std::size_t i = 0; i < fan.spokes.size(); ++i) {
    if (!fan.has(i)) continue;
    const Plan::Side& side = *plan.side_of(fan.corners[i].x);
    if (!removed_.all_of(fan.spokes[i].element, [&](const Place& place) { return is_kept(place, side); })) return most;
  }
  return most;
}

bool ShrinkingMesh::make(std::uint32_t vertex, std::uint32_t to, std::vector<std::uint32_t>& around) {
  // What it will be, and what is known of the edges that two become one.
  const Fan fan = fan_of(vertex);
  const auto towards = [&](std::uint32_t end) {
    const auto spoke = std::ranges::find(fan.spokes, end, &CollapseNet::Spoke::to);
    return static_cast<std::size_t>(spoke - fan.spokes.begin());
  };
  const std::size_t along = towards(to), right = fan.right_of(along);
  const std::optional<Plan> plan = plan_of(fan, along);
  assert(plan);
  float line_error = 0.0F;
  std::uint32_t line_end = kNothing;
  if (!fan.lines.empty()) {
    const CollapseNet::Spoke& other = fan.spokes[fan.lines[fan.lines[0] == along ? 1 : 0]];
    line_end = other.to;
    line_error = static_cast<float>(distance_from_line(vertex, {line_end, to})) +
                 std::max(line_error_[fan.spokes[along].edge], line_error_[other.edge]);
  }
  struct Rim {
    std::uint32_t end;
    float line_error;
    std::uint8_t is_whole;
  };
  std::vector<Rim> rims;
  const auto add_rim = [&](std::uint32_t corner) {
    const std::uint32_t end = welded_.class_of_vertex[corner], edge = net_.edge_between(to, end);
    rims.push_back({end, line_error_[edge], is_whole_[edge]});
  };
  if (fan.has(along)) add_rim(fan.corners[along].z);
  if (fan.has(right)) add_rim(fan.corners[right].y);
  if (!net_.collapse(vertex, to)) return false;

  // Edges: those that led to the vertex, and those that were there.
  around.clear();
  for (const CollapseNet::Spoke& spoke : fan.spokes) {
    around.push_back(spoke.to);
    if (spoke.to == to) continue;
    const std::uint32_t edge = net_.edge_between(to, spoke.to);
    is_whole_[edge] = 0;
    line_error_[edge] = spoke.to == line_end ? line_error : 0.0F;
  }
  for (const Rim& rim : rims) {
    const std::uint32_t edge = net_.edge_between(to, rim.end);
    is_whole_[edge] = rim.is_whole;
    line_error_[edge] = rim.line_error;
  }
  rewrite_elements(fan, *plan, along);
  return true;
}

void ShrinkingMesh::rewrite_elements(const Fan& fan, const Plan& plan, std::size_t along) {
  // Corners.
  for (const Plan::Side& side : plan.sides) {
    for (std::size_t k = 0; k < side.elements.size(); ++k) elements_[side.elements[k]] = side.stands[k].corners();
  }
  for (const std::size_t i : {along, fan.right_of(along)}) {
    if (fan.has(i)) elements_[fan.spokes[i].element] = glm::uvec3(kNothing);
  }

  // What they stand for.
  const auto holder = [&](const Plan::Side& side, const Place& place) {
    return side.elements[deviation_.find(place, side.stands).stand];
  };
  std::vector<std::pair<std::uint32_t, const Plan::Side*>> sides;
  for (std::size_t i = 0; i < fan.spokes.size(); ++i) {
    if (fan.has(i)) sides.emplace_back(fan.spokes[i].element, plan.side_of(fan.corners[i].x));
  }
  removed_.deal(sides, [&](const Plan::Side* side, const Place& place) { return holder(*side, place); });
  for (const Place& place : fan.places) removed_.add(holder(*plan.side_of(place.x), place), place);
}

}  // namespace radiosity
