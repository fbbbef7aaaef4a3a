// A sky's map in two parts: what hemicubes see, and what is so bright and small that it takes shadow rays.
//
// A sun is smaller than a hemicube's cell: one cell sees it, or none does. So every texel is split at one limit of
// luminance. Up to the limit it goes to the smooth part, averaged over the solid angle of a cell. The excess goes to
// the bright part, which direct light deals with like lamps. Both together are the sky, to the last lumen.
//
// The limit is a multiple of the smooth part's own mean: that bounds how far cells can differ, also in the shadow of a
// sun that outshines everything.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/sky.h"

namespace radiosity {

/// The luminance at which texels are split, cd/m2: kBrightness times the mean of what lies below it. 0 if no more
/// than a quarter of the sphere is lit at all: then all of it is bright. REQUIRES: there is a map.
float bright_limit(const Sky& sky);
inline constexpr double kBrightness = 4.0;

/// The part for hemicubes. Immutable; may be shared between threads.
class SmoothSky {
 public:
  /// Averages over about the solid angle of the cells of a hemicube `resolution` cells wide.
  SmoothSky(const Sky& sky, int resolution);

  bool is_constant() const { return cells_.empty(); }
  Rgb constant() const { return constant_; }
  bool is_black() const;
  /// Luminance in a direction (world space, of any length), cd/m2.
  Rgb luminance(const glm::vec3& direction) const { return is_constant() ? constant_ : cells_[cell_at(direction)]; }

 private:
  std::size_t cell_at(const glm::vec3& direction) const;

  Rgb constant_;  // unused if there are cells
  int resolution_;
  std::vector<Rgb> cells_;  // [6 * resolution^2], the faces of a cube around the world; empty: constant
};

/// A direction chosen for a ray.
struct ChosenDirection {
  glm::vec3 direction{0.0F};  ///< unit, world space
  Rgb irradiance{0.0F};       ///< what comes from there unoccluded, over the odds of having chosen it, lx
};

/// The part for shadow rays, in groups of neighbouring texels whose unoccluded light has a closed form. Immutable; may
/// be shared between threads.
class BrightSky {
 public:
  /// `sky` must outlive it.
  explicit BrightSky(const Sky& sky);

  bool empty() const { return groups_.empty(); }
  /// All of it on surfaces that face it, lx.
  Rgb illuminance() const;
  /// Running sums of what the groups bring to a surface with this normal unoccluded, eye-weighted, lx: `until`,
  /// [group_count]. Answers the last.
  double weigh(const glm::vec3& normal, std::vector<double>& until) const;
  /// A direction within the group at `along` in [0,1) of the sum of weights; `place` in [0,1)^2 is where in the texel.
  /// REQUIRES: the sum is above 0.
  ChosenDirection choose(std::span<const double> until, double along, const glm::vec2& place) const;

 private:
  struct Group {
    std::uint32_t first, count;  // of texels_
    Rgb illuminance;             // on a surface that faces it, were it a point, lx
    glm::vec3 direction;         // mean, eye-weighted: shorter than 1 where the group is wide
  };

  /// Groups by the cells of a grid of about `rows` x `2 rows`.
  void group_texels(int rows, float limit);
  void add_group(std::uint32_t first, std::uint32_t count, float limit);

  const Sky& sky_;
  std::vector<std::uint32_t> texels_;      // those above the limit, group by group
  std::vector<double> illuminance_until_;  // per texel: eye-weighted sum of its group up to and with it, lx
  std::vector<Group> groups_;
};

inline constexpr std::size_t kMaxSkyGroups = 256;

}  // namespace radiosity
