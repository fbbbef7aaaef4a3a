#include "core/mesh/simplify.h"

#include <algorithm>

#include "core/mesh/vertex_moves.h"
#include "core/parallel.h"

namespace radiosity {
namespace {

/// Shares of what is allowed, one after the other.
constexpr float kShares[] = {1.0F / 16.0F, 1.0F / 8.0F, 1.0F / 4.0F, 1.0F / 2.0F, 1.0F};
/// Vertices that are moved, at most, between two looks at whether to stop.
constexpr std::size_t kMovesAtOnce = 4096;

/// Rounds of moves that do not touch each other: found by all threads, made by one, cheapest first.
class Rounds {
 public:
  explicit Rounds(ShrinkingMesh& mesh)
      : mesh_(mesh), best_(mesh.vertex_count()), is_stale_(mesh.vertex_count()), is_touched_(mesh.vertex_count()) {}

  /// Until no move costs less than `allowed`.
  void run(float allowed, const Progress& progress) {
    stale_.clear();
    for (std::uint32_t v = 0; v < best_.size(); ++v) {
      if (!is_gone(v)) make_stale(v);
    }
    while (find_moves(allowed, progress)) make_moves(progress);
  }

 private:
  bool is_gone(std::uint32_t vertex) const { return best_[vertex].cost < 0.0F; }

  void make_stale(std::uint32_t vertex) {
    if (is_stale_[vertex] == 0) stale_.push_back(vertex);
    is_stale_[vertex] = 1;
  }

  /// Looks again at vertices near which something changed, or whose move had to wait.
  bool find_moves(float allowed, const Progress& progress) {
    std::ranges::sort(stale_);
    parallel_in_chunks(stale_.size(), 4 * kMovesAtOnce, progress, "",
                       [&](std::size_t k) { best_[stale_[k]] = mesh_.best_move(stale_[k], allowed); });
    moves_.clear();
    for (const std::uint32_t vertex : stale_) {
      is_stale_[vertex] = 0;
      if (best_[vertex].to != kNothing) moves_.push_back(vertex);
    }
    stale_.clear();
    std::ranges::stable_sort(moves_,
                             [this](std::uint32_t a, std::uint32_t b) { return best_[a].cost < best_[b].cost; });
    return !moves_.empty();
  }

  void make_moves(const Progress& progress) {
    std::vector<std::uint32_t> around, touched;
    for (std::size_t k = 0; k < moves_.size(); ++k) {
      if (k % kMovesAtOnce == 0) progress.update("", 0.0);
      const std::uint32_t vertex = moves_[k];
      if (is_touched_[vertex] != 0) {
        make_stale(vertex);
        continue;
      }
      if (!mesh_.make(vertex, best_[vertex].to, around)) continue;
      best_[vertex] = {kNothing, -1.0F};
      for (const std::uint32_t near : around) {
        is_touched_[near] = 1;
        touched.push_back(near);
      }
    }
    for (const std::uint32_t vertex : touched) {
      is_touched_[vertex] = 0;
      make_stale(vertex);
    }
    std::erase_if(stale_, [this](std::uint32_t vertex) { return is_gone(vertex); });
  }

  ShrinkingMesh& mesh_;
  std::vector<VertexMove> best_;  ///< [vertex_count]; of a vertex that is gone, with a negative cost
  std::vector<std::uint8_t> is_stale_, is_touched_;
  std::vector<std::uint32_t> stale_, moves_;
};

/// A third of the elements around each vertex, m2; equal vertices together.
std::vector<double> vertex_areas(const RefinedMesh& mesh, const std::vector<glm::uvec3>& elements) {
  std::vector<double> areas(mesh.positions.size(), 0.0);
  for (std::uint32_t e = 0; e < elements.size(); ++e) {
    for (int k = 0; k < 3; ++k) areas[elements[e][k]] += double{element_area(mesh, e)} / 3.0;
  }
  return areas;
}

}  // namespace

Simplified simplify(const RefinedMesh& mesh, const Carried& carried, const Progress& progress) {
  // Vertices leave.
  progress.update("simplify", 0.0);
  ShrinkingMesh shrinking(mesh, carried);
  const std::vector<double> areas = vertex_areas(mesh, shrinking.elements());
  const Progress only_cancelled{nullptr, progress.cancelled};
  Rounds rounds(shrinking);
  for (const float share : kShares) {
    rounds.run(share, only_cancelled);
    progress.update("simplify", double{share});
  }

  // What is left.
  Simplified result;
  const Deviation deviation(mesh, carried);
  for (std::uint32_t e = 0; e < mesh.elements.size(); ++e) {
    const glm::uvec3& corners = shrinking.elements()[e];
    if (corners.x == kNothing) continue;
    result.elements.push_back(e);
    result.corners.push_back(corners);
    shrinking.removed().all_of(e, [&](const Place& place) {
      const Stand stand(mesh, corners);
      const double change = deviation.of_luminance(place, corners, deviation.find(place, {&stand, 1}).weights);
      if (place.x != place.y) result.squared_light_change += areas[place.x] / 3.0 * change * change;
      return true;
    });
  }
  return result;
}

}  // namespace radiosity
