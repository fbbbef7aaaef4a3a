#include "core/mesh/subdivide_adaptive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "core/mesh/subdivide_uniform.h"

namespace radiosity {

Bisector::Bisector(CutMesh& cut, const BisectLimits& limits) : cut_(cut), limits_(limits) {
  first_edge_between_.reserve(cut.bridge.edge_count());
  for (std::uint32_t edge = 0; edge < cut.bridge.edge_count(); ++edge) remember(edge);
}

void Bisector::remember(std::uint32_t edge) {
  next_copy_.resize(std::max<std::size_t>(next_copy_.size(), edge + std::size_t{1}), kNothing);
  const auto [first, is_new] = first_edge_between_.try_emplace(pair_key(cut_.bridge.end_classes(edge)), edge);
  next_copy_[edge] = is_new ? kNothing : std::exchange(first->second, edge);
}

std::vector<std::uint32_t> Bisector::copies_of(std::uint32_t edge) const {
  std::vector<std::uint32_t> copies;
  std::uint32_t copy = first_edge_between_.at(pair_key(cut_.bridge.end_classes(edge)));
  for (; copy != kNothing; copy = next_copy_[copy]) copies.push_back(copy);
  return copies;
}

/// A total order of all edges that are not copies of each other.
bool Bisector::is_longer(std::uint32_t edge, std::uint32_t than) const {
  const glm::uvec2 ends = cut_.bridge.end_classes(edge), other_ends = cut_.bridge.end_classes(than);
  return std::pair(cut_.squared_length(ends), pair_key(ends)) >
         std::pair(cut_.squared_length(other_ends), pair_key(other_ends));
}

std::uint32_t Bisector::longest_edge_of(std::uint32_t element) const {
  const auto edges = cut_.bridge.edges_of(element);
  return *std::ranges::max_element(edges, [this](std::uint32_t a, std::uint32_t b) { return is_longer(b, a); });
}

double Bisector::longest_edge(std::uint32_t element) const {
  return std::sqrt(cut_.squared_length(cut_.bridge.end_classes(longest_edge_of(element))));
}

bool Bisector::can_be_bisected(std::uint32_t element) const {
  const auto& levels = limits_.level_of_triangle;
  if (!levels.empty() && levels[cut_.bridge.triangle_of(element)] != kLevelFromPatchSize) return false;
  const glm::uvec2 ends = cut_.bridge.end_classes(longest_edge_of(element));
  const double floor = static_cast<double>(limits_.min_edge);
  return cut_.squared_length(ends) > floor * floor && cut_.can_be_halved(ends);
}

/// A longer edge of an element at `edge` or a copy of it; kNothing if there is none.
std::uint32_t Bisector::edge_to_halve_before(std::uint32_t edge) const {
  for (const std::uint32_t copy : copies_of(edge)) {
    for (unsigned int side = 0; side < 2; ++side) {
      const std::uint32_t element = cut_.bridge.element_at(copy, side);
      if (element == kNothing) continue;
      const std::uint32_t longest = longest_edge_of(element);
      if (is_longer(longest, edge)) return longest;
    }
  }
  return kNothing;
}

bool Bisector::fits(std::span<const std::uint32_t> copies) const {
  std::set<std::uint64_t> new_vertices;
  std::size_t new_elements = 0;
  for (const std::uint32_t copy : copies) {
    for (unsigned int side = 0; side < 2; ++side) {
      if (cut_.bridge.triangle_at(copy, side) == kNothing) continue;
      new_vertices.insert(pair_key(cut_.bridge.vertices_at(copy, side)));
      ++new_elements;
    }
  }
  return cut_.mesh.positions.size() + new_vertices.size() <= limits_.max_vertices &&
         cut_.bridge.face_count() + new_elements <= limits_.max_elements;
}

void Bisector::halve_all(std::span<const std::uint32_t> copies) {
  first_edge_between_.erase(pair_key(cut_.bridge.end_classes(copies.front())));
  std::map<std::uint64_t, std::uint32_t> midpoint_of_pair;
  for (const std::uint32_t copy : copies) {
    // One midpoint for each pair of vertices that ends this edge or a copy of it.
    std::array<std::uint32_t, 2> midpoint_of_side{kNothing, kNothing};
    std::array<std::uint32_t, 2> element_of_side{kNothing, kNothing};
    for (unsigned int side = 0; side < 2; ++side) {
      element_of_side[side] = cut_.bridge.element_at(copy, side);
      if (element_of_side[side] == kNothing) continue;
      const glm::uvec2 ends = cut_.bridge.vertices_at(copy, side);
      const auto [found, is_new] = midpoint_of_pair.try_emplace(pair_key(ends), kNothing);
      if (is_new) found->second = cut_.add_midpoint(ends);
      midpoint_of_side[side] = found->second;
    }

    const std::uint32_t edge_count = cut_.bridge.edge_count();
    const std::array<std::uint32_t, 2> added = cut_.halve(copy, midpoint_of_side);

    // What came of it.
    remember(copy);
    for (std::uint32_t edge = edge_count; edge < cut_.bridge.edge_count(); ++edge) remember(edge);
    origin_.resize(cut_.bridge.face_count());
    for (unsigned int side = 0; side < 2; ++side) {
      if (added[side] == kNothing) continue;
      origin_[added[side]] = origin_[element_of_side[side]];
      is_cut_[origin_[added[side]]] = 1;
    }
  }
}

void Bisector::bisect_at(std::uint32_t edge) {
  std::vector<std::uint32_t> waiting{edge};  // each longer than the one before: it ends
  while (!waiting.empty()) {
    const std::uint32_t before = edge_to_halve_before(waiting.back());
    if (before != kNothing) {
      waiting.push_back(before);
      continue;
    }
    const std::vector<std::uint32_t> copies = copies_of(waiting.back());
    reached_limit_ = reached_limit_ || !fits(copies);
    if (reached_limit_) return;
    halve_all(copies);
    waiting.pop_back();
  }
}

std::vector<std::uint32_t> Bisector::bisect(std::span<const std::uint32_t> elements) {
  origin_.resize(cut_.bridge.face_count());
  std::iota(origin_.begin(), origin_.end(), 0U);
  is_cut_.assign(origin_.size(), 0);
  cut_.bridge.begin_round(0, 0);
  for (const std::uint32_t element : elements) {
    if (reached_limit_) break;
    if (is_cut_[element] == 0 && can_be_bisected(element)) bisect_at(longest_edge_of(element));
  }
  cut_.write_elements();
  return std::move(origin_);
}

void Bisector::bisect_longer_than(double length) {
  std::vector<std::uint32_t> longer;
  do {
    longer.clear();
    for (std::uint32_t element = 0; element < cut_.bridge.face_count(); ++element) {
      if (longest_edge(element) > length && can_be_bisected(element)) longer.push_back(element);
    }
    bisect(longer);
  } while (!longer.empty() && !reached_limit_);
}

}  // namespace radiosity
