#include "core/mesh/subdivide_adaptive.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/mesh/subdivide_uniform.h"

namespace radiosity {

Bisector::Bisector(CutMesh& cut, EdgeCopies& edges, const BisectLimits& limits, ContactCutter* contacts)
    : cut_(cut), edges_(edges), limits_(limits), contacts_(contacts) {}

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
  for (const std::uint32_t copy : edges_.copies_of(edge)) {
    for (unsigned int side = 0; side < 2; ++side) {
      const std::uint32_t element = cut_.bridge.element_at(copy, side);
      if (element == kNothing) continue;
      const std::uint32_t longest = longest_edge_of(element);
      if (is_longer(longest, edge)) return longest;
    }
  }
  return kNothing;
}

void Bisector::note(std::span<const EdgeCopies::Part> parts) {
  origin_.resize(cut_.bridge.face_count());
  for (const EdgeCopies::Part& part : parts) {
    origin_[part.element] = origin_[part.of_element];
    is_cut_[origin_[part.element]] = 1;
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
    const std::vector<std::uint32_t> copies = edges_.copies_of(waiting.back());
    reached_limit_ = reached_limit_ || !edges_.fits(copies, limits_.mesh);
    if (reached_limit_) return;
    note(edges_.halve(copies));
    waiting.pop_back();
  }
}

std::vector<std::uint32_t> Bisector::bisect(std::span<const std::uint32_t> elements) {
  begin_round();
  for (const std::uint32_t element : elements) {
    if (reached_limit_) break;
    if (is_cut_[element] != 0 || !can_be_bisected(element)) continue;
    if (contacts_ != nullptr && contacts_->is_parted(element)) note(contacts_->cut(element, limits_.mesh));
    if (is_cut_[element] == 0) bisect_at(longest_edge_of(element));
  }
  cut_.write_elements();
  if (contacts_ != nullptr) contacts_->split_sides(limits_.mesh);
  return std::move(origin_);
}

void Bisector::begin_round() {
  origin_.resize(cut_.bridge.face_count());
  std::iota(origin_.begin(), origin_.end(), 0U);
  is_cut_.assign(origin_.size(), 0);
  cut_.bridge.begin_round(0, 0);
}

void Bisector::bisect_longer_than(double length) {
  const auto is_longer = [&](std::uint32_t element) {
    return longest_edge(element) > length && can_be_bisected(element);
  };
  for (bool done = false; !done && !reached_limit_;) {
    done = true;
    begin_round();
    const auto count = static_cast<std::uint32_t>(origin_.size());
    for (std::uint32_t element = 0; element < count && !reached_limit_; ++element) {
      if (is_cut_[element] != 0 || !is_longer(element)) continue;
      bisect_at(longest_edge_of(element));
      done = false;
    }
  }
  cut_.write_elements();
}

}  // namespace radiosity
