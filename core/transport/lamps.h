// What each lamp would bring to a point if nothing were in between, and which lamps are worth a shadow ray.
//
// The lamps of one patch form a group. A point far from a group weighs it as a whole by an estimate; near groups are
// opened and their lamps weighed by the closed form. Rays are then dealt out in proportion to weight, and what a ray
// brings is always the exact light of the lamp it went to over the odds of having chosen it: the estimates cost
// accuracy nowhere, and thousands of lamps cost a point no more than their patches.
//
// Irradiance from a polygon: Lambert 1760, as in Baum, Rushmeier and Winget 1989.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/patches.h"

namespace radiosity {

/// Irradiance (lx) that an unoccluded triangle of uniform luminance 1 cd/m2 brings to a point, with what lies below the
/// point's horizon cut off. Corners counter-clockwise seen from the front; negative where the point sees the back.
float triangle_irradiance(const glm::vec3 corner[3], const SurfacePoint& at);

/// A lamp chosen for a ray.
struct ChosenLamp {
  std::uint32_t lamp = 0;
  Rgb irradiance{0.0F};  ///< what it brings unoccluded, over the odds of having chosen it, lx
};

/// The lamps as one point weighs them. Reused from point to point.
struct LampWeights {
  struct Entry {
    double until;         // sum of weights up to and with this entry
    std::uint32_t first;  // a lamp, or the first of a group
    std::uint32_t count;  // 1, or all of a group
  };
  std::vector<Entry> entries;
  double total =
      0.0;  ///< sum of all weights, about the eye-weighted irradiance of all lamps, lx; 0 where none can shine
};

/// Immutable; may be shared between threads.
class Lamps {
 public:
  /// `tiles` are ordered by patch and must outlive this. A point within `surface_offset` (m) of a lamp's plane sees it
  /// edge-on and gets nothing from it.
  Lamps(std::span<const EmissiveTile> tiles, float surface_offset);

  bool empty() const { return tiles_.empty(); }
  const EmissiveTile& tile(std::uint32_t lamp) const { return tiles_[lamp]; }

  void weigh(const SurfacePoint& point, LampWeights& weights) const;
  /// The lamp at `along` in [0, 1) of the sum of weights. REQUIRES: weights.total > 0.
  ChosenLamp choose(const SurfacePoint& point, const LampWeights& weights, double along) const;

 private:
  struct Group {
    std::uint32_t first, count;
    glm::vec3 middle;
    float radius;      // m, of a sphere around the middle that holds all lamps
    glm::vec3 facing;  // mean normal, weighted by flux: shorter than 1 where the group is curved
    double flux;       // sum of area times eye-weighted luminance
    bool two_sided;
  };

  Group make_group(std::uint32_t first, std::uint32_t count) const;
  double weight_of_far_group(const Group& group, const SurfacePoint& point) const;
  double irradiance_of_lamp(std::uint32_t lamp, const SurfacePoint& point) const;

  std::span<const EmissiveTile> tiles_;
  float surface_offset_;
  std::vector<Group> groups_;
  std::vector<double> flux_until_;  // per lamp: flux of its group's lamps up to and with it
  std::vector<float> reach2_;       // per lamp: squared distance (m2) beyond which it counts as a point
};

}  // namespace radiosity
