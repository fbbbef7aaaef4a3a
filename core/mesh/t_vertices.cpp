#include "core/mesh/t_vertices.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <tuple>
#include <unordered_map>

#include "core/mesh/weld.h"
#include "core/scene.h"

namespace radiosity {
namespace {

/// An edge that one element has, by the weld classes of its ends.
struct OpenEdge {
  glm::uvec2 classes{0};   // the smaller first
  glm::uvec2 vertices{0};  // as the element names them
  std::uint32_t apex = 0;  // the class of the element's third corner, which may lie on the edge: a sliver, no crack
};

std::vector<OpenEdge> open_edges(std::span<const glm::uvec3> triangles, const Weld& welded) {
  std::vector<OpenEdge> edges;
  edges.reserve(3 * triangles.size());
  for (const glm::uvec3& triangle : triangles) {
    for (int k = 0; k < 3; ++k) {
      const glm::uvec2 ends(triangle[k], triangle[(k + 1) % 3]);
      const auto [low, high] = std::minmax({welded.class_of_vertex[ends.x], welded.class_of_vertex[ends.y]});
      if (low != high) edges.push_back({{low, high}, ends, welded.class_of_vertex[triangle[(k + 2) % 3]]});
    }
  }
  const auto order = [](const OpenEdge& e) { return std::tuple(e.classes.x, e.classes.y, e.vertices.x, e.vertices.y); };
  std::ranges::sort(edges, {}, order);

  // Those that occur once.
  std::vector<OpenEdge> open;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool as_before = i > 0 && edges[i - 1].classes == edges[i].classes;
    const bool as_after = i + 1 < edges.size() && edges[i + 1].classes == edges[i].classes;
    if (!as_before && !as_after) open.push_back(edges[i]);
  }
  return open;
}

/// Places in cubes of one size.
class Cells {
 public:
  explicit Cells(double size) : size_(size) {}

  void add(const glm::dvec3& at, std::uint32_t item) { items_[key(at)].push_back(item); }

  /// Calls `visit(item)` for all items within half a cell of the line between two places, some more than once.
  template <typename Visit>
  void along(const glm::dvec3& a, const glm::dvec3& b, const Visit& visit) const {
    const int steps = 1 + static_cast<int>(glm::length(b - a) / size_);
    for (int i = 0; i <= steps; ++i) {
      const glm::dvec3 at = glm::mix(a, b, static_cast<double>(i) / steps);
      for (int around = 0; around < 27; ++around) {
        const glm::dvec3 offset(around % 3 - 1, around / 3 % 3 - 1, around / 9 - 1);
        const auto found = items_.find(key(at + size_ * offset));
        if (found == items_.end()) continue;
        for (const std::uint32_t item : found->second) visit(item);
      }
    }
  }

 private:
  std::uint64_t key(const glm::dvec3& at) const {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
      hash = (hash ^ static_cast<std::uint64_t>(std::llround(at[axis] / size_))) * 0x9e3779b97f4a7c15ULL;
      hash ^= hash >> 29U;
    }
    return hash;
  }

  double size_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> items_;
};

/// The vertices at the ends of open edges, one for each class.
std::vector<std::uint32_t> ends_of(std::span<const OpenEdge> edges, const Weld& welded) {
  std::vector<std::uint32_t> vertices, vertex_of_class(welded.class_count, kNothing);
  for (const OpenEdge& edge : edges) {
    for (const std::uint32_t vertex : {edge.vertices.x, edge.vertices.y}) {
      std::uint32_t& known = vertex_of_class[welded.class_of_vertex[vertex]];
      if (known == kNothing) vertices.push_back(known = vertex);
    }
  }
  return vertices;
}

double mean_length(std::span<const OpenEdge> edges, std::span<const glm::vec3> positions) {
  double sum = 0.0;
  for (const OpenEdge& edge : edges) {
    sum += glm::length(glm::dvec3(positions[edge.vertices.x]) - glm::dvec3(positions[edge.vertices.y]));
  }
  return sum / static_cast<double>(edges.size());
}

}  // namespace

std::vector<TVertex> find_t_vertices(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                                     float tolerance) {
  const Weld welded = weld(positions);
  const std::vector<OpenEdge> edges = open_edges(triangles, welded);
  if (edges.empty()) return {};
  Cells cells(std::max(mean_length(edges, positions), 4.0 * double{tolerance}));
  for (const std::uint32_t vertex : ends_of(edges, welded)) cells.add(positions[vertex], vertex);

  std::vector<TVertex> found;
  for (const OpenEdge& edge : edges) {
    const glm::dvec3 a(positions[edge.vertices.x]), b(positions[edge.vertices.y]);
    const double length = glm::length(b - a);
    const glm::dvec3 along = (b - a) / length;
    const auto first = static_cast<std::ptrdiff_t>(found.size());
    cells.along(a, b, [&](std::uint32_t vertex) {
      if (welded.class_of_vertex[vertex] == edge.apex) return;
      const glm::dvec3 offset = glm::dvec3(positions[vertex]) - a;
      const double at = glm::dot(offset, along);
      const bool inside = at > double{tolerance} && at < length - double{tolerance};
      if (!inside || glm::length(offset - at * along) > double{tolerance}) return;
      found.push_back({vertex, edge.vertices, static_cast<float>(at / length)});
    });
    std::sort(found.begin() + first, found.end(),
              [](const TVertex& l, const TVertex& r) { return std::tie(l.at, l.vertex) < std::tie(r.at, r.vertex); });
    const auto same = [](const TVertex& l, const TVertex& r) { return l.vertex == r.vertex; };
    found.erase(std::unique(found.begin() + first, found.end(), same), found.end());
  }
  return found;
}

float rounding_tolerance(std::span<const glm::vec3> positions) {
  if (positions.empty()) return 0.0F;
  glm::vec3 least = positions.front(), most = positions.front(), farthest(0.0F);
  for (const glm::vec3& position : positions) {
    least = glm::min(least, position);
    most = glm::max(most, position);
    farthest = glm::max(farthest, glm::abs(position));
  }
  return 1e-6F * std::max(glm::distance(least, most), std::max({farthest.x, farthest.y, farthest.z}));
}

}  // namespace radiosity
