// What each lamp would bring to a point if nothing were in between, and which lamps are worth a shadow ray.
//
// Lamps form a tree of groups, neighbours together. A point weighs what is far as a whole by an estimate; what is near
// is opened, down to single lamps that are weighed by the closed form. Rays are then dealt out in proportion to weight,
// and what a ray brings is always the exact light of the lamp it went to over the odds of having chosen it: the
// estimates bias nothing, and a point pays for thousands of lamps with the logarithm of their number.
//
// Irradiance from a polygon: Lambert 1760, as in Baum, Rushmeier and Winget 1989. Trees of lights: Walter, Fernandez,
// Arbree, Bala, Donikian and Greenberg. Lightcuts: A Scalable Approach to Illumination. 2005
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
  /// A point within `surface_offset` (m) of a lamp's plane sees it edge-on and gets nothing from it.
  Lamps(std::span<const EmissiveTile> tiles, float surface_offset);

  bool empty() const { return tiles_.empty(); }
  const EmissiveTile& tile(std::uint32_t lamp) const { return tiles_[lamp]; }

  void weigh(const SurfacePoint& point, LampWeights& weights) const;
  /// The lamp at `along` in [0, 1) of the sum of weights. REQUIRES: weights.total > 0.
  ChosenLamp choose(const SurfacePoint& point, const LampWeights& weights, double along) const;

 private:
  /// A node of the tree. Its lamps are neighbours in `tiles_`; the first child comes next in `groups_`.
  struct Group {
    std::uint32_t first = 0, count = 0;
    std::uint32_t second_child = 0;
    glm::vec3 middle{0.0F};  // m, weighted by flux
    float radius = 0.0F;     // m, of a sphere around the middle that holds all lamps
    glm::vec3 facing{0.0F};  // mean normal, weighted by flux: shorter than 1 where the group is curved
    double flux = 0.0;       // sum of area times eye-weighted luminance
    bool two_sided = false;
  };

  std::uint32_t build(std::uint32_t first, std::uint32_t count);
  Group describe(std::uint32_t first, std::uint32_t count) const;
  double weight_of_far_group(const Group& group, const SurfacePoint& point) const;
  double irradiance_of_lamp(std::uint32_t lamp, const SurfacePoint& point) const;

  std::vector<EmissiveTile> tiles_;
  float surface_offset_;
  std::vector<Group> groups_;       // the root first
  std::vector<double> flux_until_;  // [lamp_count + 1]: flux of all lamps before
  std::vector<float> reach2_;       // per lamp: squared distance (m2) beyond which it counts as a point
};

}  // namespace radiosity
