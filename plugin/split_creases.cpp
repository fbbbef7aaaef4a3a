#include "plugin/split_creases.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numeric>
#include <unordered_map>

#include "core/mesh/weld.h"
#include "core/scene.h"

namespace gltf_radiosity {
namespace {

using radiosity::kNothing;

/// Edges with more faces than this are nobody's smooth surface.
constexpr std::size_t kMaxFacesAtEdge = 8;

/// Disjoint sets of corners (triangle * 3 + corner).
class CornerSets {
 public:
  explicit CornerSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t find(std::uint32_t corner) {
    while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
    return corner;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

struct HalfEdge {
  std::uint64_t ends = 0;         ///< weld classes, smaller one in the upper half
  std::uint32_t low_corner = 0;   ///< the corner at the smaller class
  std::uint32_t high_corner = 0;  ///< the corner at the larger class
  bool operator<(const HalfEdge& other) const {
    return ends != other.ends ? ends < other.ends : low_corner < other.low_corner;
  }
};

/// Unit normals in doubles; zero for triangles without area.
std::vector<glm::dvec3> face_normals(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles) {
  std::vector<glm::dvec3> normals;
  normals.reserve(triangles.size());
  for (const glm::uvec3& corners : triangles) {
    const glm::dvec3 a(positions[corners.x]), b(positions[corners.y]), c(positions[corners.z]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double length = glm::length(normal);
    normals.push_back(length > 0.0 && std::isfinite(length) ? normal / length : glm::dvec3(0.0));
  }
  return normals;
}

std::vector<HalfEdge> sorted_edges(const radiosity::Weld& weld, std::span<const glm::uvec3> triangles,
                                   std::span<const glm::dvec3> normals) {
  std::vector<HalfEdge> edges;
  edges.reserve(triangles.size() * 3);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (normals[t] == glm::dvec3(0.0)) continue;
    for (std::uint32_t side = 0; side < 3; ++side) {
      std::uint32_t from = t * 3 + side, to = t * 3 + (side + 1) % 3;
      std::uint64_t low = weld.class_of_vertex[triangles[t][static_cast<int>(side)]];
      std::uint64_t high = weld.class_of_vertex[triangles[t][static_cast<int>((side + 1) % 3)]];
      if (low > high) {
        std::swap(low, high);
        std::swap(from, to);
      }
      edges.push_back({low << 32 | high, from, to});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

}  // namespace

std::vector<std::uint32_t> split_creases(std::span<const glm::vec3> positions, std::vector<glm::uvec3>& triangles) {
  // Join the corners of neighbours that do not crease.
  const std::vector<glm::dvec3> normals = face_normals(positions, triangles);
  const std::vector<HalfEdge> edges = sorted_edges(radiosity::weld(positions), triangles, normals);
  const double least_cosine = std::cos(glm::radians(kCreaseDegrees));
  CornerSets sets(triangles.size() * 3);
  for (std::size_t first = 0, last = 0; first < edges.size(); first = last) {
    while (last < edges.size() && edges[last].ends == edges[first].ends) ++last;
    if (last - first > kMaxFacesAtEdge) continue;
    for (std::size_t a = first; a < last; ++a) {
      for (std::size_t b = a + 1; b < last; ++b) {
        if (glm::dot(normals[edges[a].low_corner / 3], normals[edges[b].low_corner / 3]) < least_cosine) continue;
        sets.join(edges[a].low_corner, edges[b].low_corner);
        sets.join(edges[a].high_corner, edges[b].high_corner);
      }
    }
  }

  // The first set at a vertex keeps it, every further one gets a copy.
  std::vector<std::uint32_t> source(positions.size());
  std::iota(source.begin(), source.end(), 0U);
  std::vector<std::uint32_t> keeper(positions.size(), kNothing);
  std::unordered_map<std::uint64_t, std::uint32_t> copies;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (normals[t] == glm::dvec3(0.0)) continue;
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      std::uint32_t& vertex = triangles[t][static_cast<int>(corner)];
      const std::uint32_t set = sets.find(t * 3 + corner);
      if (keeper[vertex] == kNothing) keeper[vertex] = set;
      if (keeper[vertex] == set) continue;
      const auto [copy, added] =
          copies.try_emplace(std::uint64_t{vertex} << 32 | set, static_cast<std::uint32_t>(source.size()));
      if (added) source.push_back(vertex);
      vertex = copy->second;
    }
  }
  if (source.size() == positions.size()) source.clear();
  return source;
}

}  // namespace gltf_radiosity
