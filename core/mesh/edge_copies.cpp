#include "core/mesh/edge_copies.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <map>
#include <set>
#include <utility>

namespace radiosity {
namespace {

/// The same place from either end, to the last bit: what edges share across primitives must not open.
constexpr float kStepsOfShare = 4194304.0F;

}  // namespace

EdgeCopies::EdgeCopies(CutMesh& cut) : cut_(cut) {
  first_edge_between_.reserve(cut.bridge.edge_count());
  for (std::uint32_t edge = 0; edge < cut.bridge.edge_count(); ++edge) remember(edge);
}

void EdgeCopies::remember(std::uint32_t edge) {
  next_copy_.resize(std::max<std::size_t>(next_copy_.size(), edge + std::size_t{1}), kNothing);
  const auto [first, is_new] = first_edge_between_.try_emplace(pair_key(cut_.bridge.end_classes(edge)), edge);
  next_copy_[edge] = is_new ? kNothing : std::exchange(first->second, edge);
}

std::vector<std::uint32_t> EdgeCopies::copies_of(std::uint32_t edge) const {
  std::vector<std::uint32_t> copies;
  std::uint32_t copy = first_edge_between_.at(pair_key(cut_.bridge.end_classes(edge)));
  for (; copy != kNothing; copy = next_copy_[copy]) copies.push_back(copy);
  return copies;
}

bool EdgeCopies::turn(std::uint32_t edge) {
  const std::uint64_t before = pair_key(cut_.bridge.end_classes(edge));
  const std::uint64_t after = pair_key(cut_.bridge.opposite_classes(edge));
  const bool has_copies = first_edge_between_.at(before) != edge || next_copy_[edge] != kNothing;
  if (has_copies || first_edge_between_.contains(after) || !cut_.bridge.turn(edge)) return false;
  first_edge_between_.erase(before);
  remember(edge);
  return true;
}

bool EdgeCopies::fits(std::span<const std::uint32_t> copies, const MeshLimits& limits) const {
  std::set<std::uint64_t> new_vertices;
  std::size_t new_elements = 0;
  for (const std::uint32_t copy : copies) {
    for (unsigned int side = 0; side < 2; ++side) {
      if (cut_.bridge.triangle_at(copy, side) == kNothing) continue;
      new_vertices.insert(pair_key(cut_.bridge.vertices_at(copy, side)));
      ++new_elements;
    }
  }
  const bool is_seam = cut_.seams.contains(pair_key(cut_.bridge.end_classes(copies.front())));
  return cut_.mesh.positions.size() + (is_seam ? new_elements : new_vertices.size()) <= limits.max_vertices &&
         cut_.bridge.face_count() + new_elements <= limits.max_elements;
}

std::vector<EdgeCopies::Part> EdgeCopies::halve(std::span<const std::uint32_t> copies) { return cut(copies, 0.5F); }

std::vector<EdgeCopies::Part> EdgeCopies::cut(std::span<const std::uint32_t> copies, float at) {
  // Where, and what lies between the ends from now on.
  const float share = glm::round(at * kStepsOfShare) / kStepsOfShare;
  const glm::uvec2 ends = cut_.bridge.end_classes(copies.front());
  const std::uint32_t middle = cut_.class_between(ends, share);
  first_edge_between_.erase(pair_key(ends));
  const bool is_seam = cut_.split_seam(ends, middle);

  std::vector<Part> parts;
  std::map<std::uint64_t, std::uint32_t> vertex_between;
  for (const std::uint32_t copy : copies) {
    // One new vertex for each pair of vertices that ends this edge or a copy of it.
    std::array<std::uint32_t, 2> vertex_of_side{kNothing, kNothing}, element_of_side{kNothing, kNothing};
    for (unsigned int side = 0; side < 2; ++side) {
      element_of_side[side] = cut_.bridge.element_at(copy, side);
      if (element_of_side[side] == kNothing) continue;
      const glm::uvec2 vertices = cut_.bridge.vertices_at(copy, side);
      const auto [found, is_new] = vertex_between.try_emplace(pair_key(vertices), kNothing);
      if (is_new || is_seam) found->second = cut_.add_between(vertices, ends, share, middle);
      if (is_seam) cut_.set_apart(found->second);
      vertex_of_side[side] = found->second;
    }

    // What came of it.
    const std::uint32_t edge_count = cut_.bridge.edge_count();
    const std::array<std::uint32_t, 2> added =
        cut_.bridge.cut(copy, share, middle, cut_.welder.positions()[middle], vertex_of_side);
    remember(copy);
    for (std::uint32_t edge = edge_count; edge < cut_.bridge.edge_count(); ++edge) remember(edge);
    for (unsigned int side = 0; side < 2; ++side) {
      if (added[side] != kNothing) parts.push_back({element_of_side[side], added[side]});
    }
  }
  return parts;
}

}  // namespace radiosity
