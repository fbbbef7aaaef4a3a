#include "core/mesh/subdivide_uniform.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "core/mesh/openmesh_bridge.h"
#include "core/mesh/stitch.h"

namespace radiosity {
namespace {

/// OpenMesh numbers halfedges with int; three or so per element.
constexpr std::size_t kMostElements = 300'000'000;

/// How many elements the default patch size is meant to give.
constexpr double kDefaultElementCount = 4000.0;

/// Edges between two looks at the progress: about a millisecond of work.
constexpr std::size_t kEdgesPerUpdate = 4096;

/// The rounds of a subdivision (see the header), on the edges of a bridge to OpenMesh.
class Subdivider {
 public:
  Subdivider(CutMesh& cut, const SubdivideOptions& options, const Progress& progress)
      : options_(options), progress_(progress), cut_(cut), bridge_(cut.bridge) {}

  /// Returns whether the limit ended it early.
  bool run();

 private:
  std::int8_t level_of(std::uint32_t triangle) const {
    return options_.level_of_triangle.empty() ? kLevelFromPatchSize : options_.level_of_triangle[triangle];
  }
  bool asks(std::uint32_t triangle, const glm::uvec2& end_classes) const;
  void report_at(std::uint32_t edge, double from, double to) const;
  void mark(std::uint32_t edge);
  void mark_asked_edges();
  void mark_copies();
  void halve_marked_edges();
  std::array<std::uint32_t, 2> midpoint_of_sides(std::uint32_t edge);
  double rounds_left() const;

  const SubdivideOptions& options_;
  const Progress& progress_;
  CutMesh& cut_;
  OpenMeshBridge& bridge_;

  int round_ = 0;
  double progress_before_round_ = 0.0;
  double progress_after_round_ = 0.0;
  std::vector<bool> is_marked_;                                        ///< [edge_count], this round
  std::size_t marked_count_ = 0;                                       ///< this round
  std::size_t marked_side_count_ = 0;                                  ///< triangles at marked edges, this round
  std::unordered_map<std::uint64_t, std::uint32_t> midpoint_of_pair_;  ///< this round, where edges may have copies
};

bool Subdivider::asks(std::uint32_t triangle, const glm::uvec2& end_classes) const {
  if (triangle == kNothing) {
    return false;
  }
  const std::int8_t level = level_of(triangle);
  if (level >= 0) {
    return level > round_;
  }
  const double patch_size = static_cast<double>(options_.patch_size);
  return patch_size > 0.0 && cut_.squared_length(end_classes) > patch_size * patch_size;
}

/// Reports now and then while `edge` runs through all edges.
void Subdivider::report_at(std::uint32_t edge, double from, double to) const {
  if (edge % kEdgesPerUpdate == 0) {
    progress_.update("subdivide",
                     std::lerp(from, to, static_cast<double>(edge) / static_cast<double>(is_marked_.size())));
  }
}

void Subdivider::mark(std::uint32_t edge) {
  is_marked_[edge] = true;
  ++marked_count_;
  marked_side_count_ += bridge_.triangle_at(edge, 0) != kNothing ? 1U : 0U;
  marked_side_count_ += bridge_.triangle_at(edge, 1) != kNothing ? 1U : 0U;
}

void Subdivider::mark_asked_edges() {
  is_marked_.assign(bridge_.edge_count(), false);
  marked_count_ = 0;
  marked_side_count_ = 0;
  for (std::uint32_t edge = 0; edge < is_marked_.size(); ++edge) {
    report_at(edge, progress_before_round_, progress_before_round_);
    const glm::uvec2 ends = bridge_.end_classes(edge);
    const bool is_asked_for = asks(bridge_.triangle_at(edge, 0), ends) || asks(bridge_.triangle_at(edge, 1), ends);
    if (is_asked_for && cut_.can_be_halved(ends)) {
      mark(edge);
    }
  }
}

void Subdivider::mark_copies() {
  // Which pairs of ends are to be halved, of those edges that may have copies.
  std::unordered_set<std::uint64_t> marked_pairs;
  for (std::uint32_t edge = 0; edge < is_marked_.size(); ++edge) {
    report_at(edge, progress_before_round_, progress_before_round_);
    if (is_marked_[edge] && bridge_.may_have_copies(edge)) {
      marked_pairs.insert(pair_key(bridge_.end_classes(edge)));
    }
  }
  if (marked_pairs.empty()) {
    return;
  }

  // All edges between them.
  for (std::uint32_t edge = 0; edge < is_marked_.size(); ++edge) {
    report_at(edge, progress_before_round_, progress_before_round_);
    if (!is_marked_[edge] && bridge_.may_have_copies(edge) &&
        marked_pairs.contains(pair_key(bridge_.end_classes(edge)))) {
      mark(edge);
    }
  }
}

/// One midpoint for each pair of vertices that ends this edge or a copy of it.
std::array<std::uint32_t, 2> Subdivider::midpoint_of_sides(std::uint32_t edge) {
  const bool may_have_copies = bridge_.may_have_copies(edge);
  std::array<std::uint64_t, 2> pair{};
  std::array<std::uint32_t, 2> vertex{kNothing, kNothing};
  for (unsigned int side = 0; side < 2; ++side) {
    if (bridge_.triangle_at(edge, side) == kNothing) {
      continue;
    }
    const glm::uvec2 ends = bridge_.vertices_at(edge, side);
    pair[side] = pair_key(ends);
    if (may_have_copies) {
      const auto [found, is_new] = midpoint_of_pair_.try_emplace(pair[side], kNothing);
      if (is_new) {
        found->second = cut_.add_midpoint(ends);
      }
      vertex[side] = found->second;
    } else if (side == 1 && vertex[0] != kNothing && pair[1] == pair[0]) {
      vertex[1] = vertex[0];
    } else {
      vertex[side] = cut_.add_midpoint(ends);
    }
  }
  return vertex;
}

void Subdivider::halve_marked_edges() {
  midpoint_of_pair_.clear();
  bridge_.begin_round(marked_count_, marked_side_count_);
  for (std::uint32_t edge = 0; edge < is_marked_.size(); ++edge) {
    report_at(edge, progress_before_round_, progress_after_round_);
    if (is_marked_[edge]) {
      cut_.halve(edge, midpoint_of_sides(edge));
    }
  }
  bridge_.end_round();
}

/// Rounds to come, as far as one can tell: the longest edge over the patch size, or the highest level.
double Subdivider::rounds_left() const {
  double longest = 0.0;
  int level = 0;
  for (std::uint32_t edge = 0; edge < bridge_.edge_count(); ++edge) {
    const glm::uvec2 ends = bridge_.end_classes(edge);
    longest = std::max(longest, cut_.squared_length(ends));
  }
  for (const std::int8_t asked : options_.level_of_triangle) {
    level = std::max<int>(level, asked);
  }
  const double patch_size = static_cast<double>(options_.patch_size);
  const double rounds = patch_size > 0.0 ? std::ceil(0.5 * std::log2(longest / (patch_size * patch_size))) : 0.0;
  return std::max({rounds, static_cast<double>(level), 1.0});
}

bool Subdivider::run() {
  const std::size_t max_elements = std::min(options_.max_elements, kMostElements);
  const double expected_rounds = rounds_left();
  bool reached_limit = false;
  for (;; ++round_) {
    // Each round has four times the work of the one before.
    progress_before_round_ = progress_after_round_;
    progress_after_round_ = std::min(1.0, std::pow(4.0, round_ + 1.0 - expected_rounds));
    progress_.update("subdivide", progress_before_round_);

    mark_asked_edges();
    if (marked_count_ == 0) {
      break;
    }
    mark_copies();
    if (bridge_.face_count() + marked_side_count_ > max_elements) {
      reached_limit = true;
      break;
    }
    halve_marked_edges();
  }
  if (round_ > 0) {
    cut_.write_elements();
  }
  progress_.update("subdivide", 1.0);
  return reached_limit;
}

/// Whether no triangle can ask for anything.
bool wants_nothing(const SubdivideOptions& options) {
  const std::int8_t lowest_idle = options.patch_size > 0.0F ? 0 : kLevelFromPatchSize;
  const bool idle_without_levels = !(options.patch_size > 0.0F);
  return options.level_of_triangle.empty() ? idle_without_levels
                                           : std::ranges::all_of(options.level_of_triangle, [=](std::int8_t level) {
                                               return level >= lowest_idle && level <= 0;
                                             });
}

}  // namespace

bool subdivide_uniform(CutMesh& cut, const SubdivideOptions& options, const Progress& progress) {
  progress.update("subdivide", 0.0);
  return !wants_nothing(options) && Subdivider(cut, options, progress).run();
}

Subdivision subdivide_uniform(const Scene& scene, const SubdivideOptions& options, const Progress& progress) {
  assert(options.level_of_triangle.empty() || options.level_of_triangle.size() == scene.triangles.size());
  progress.update("subdivide", 0.0);
  if (wants_nothing(options)) {
    return {.mesh = unrefined(scene)};
  }
  CutMesh cut(scene);
  stitch(cut, options.max_elements - std::min(options.max_elements, scene.triangles.size()));
  Subdivision result;
  result.reached_limit = subdivide_uniform(cut, options, progress);
  result.mesh = std::move(cut.mesh);
  group_by_triangle(result.mesh, scene.triangles.size());
  return result;
}

float default_patch_size(const Scene& scene) {
  double area = 0.0;
  for (std::uint32_t triangle = 0; triangle < scene.triangles.size(); ++triangle) {
    area += 0.5 * static_cast<double>(glm::length(scaled_normal(scene, triangle)));
  }
  return static_cast<float>(std::sqrt(area / kDefaultElementCount));
}

float coarse_patch_size(const Scene& scene) { return diagonal(scene) / 3.0F; }

}  // namespace radiosity
