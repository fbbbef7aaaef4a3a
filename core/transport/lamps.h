// What each lamp would bring to a point if nothing were in between, and which lamps are worth a shadow ray.
//
// Lamps form a tree of groups, neighbours together. A point takes what is far, flat and wholly in its view as one lamp,
// which is wrong by half a per cent at most (kFar in lamps.cpp); what is near is opened, down to single lamps that have
// a closed form. Rays are then dealt out in proportion to what each brings and only decide visibility: a point pays for
// thousands of lamps with the logarithm of their number, and where all are in view every ray says the same.
//
// Every surface has a tree of its own, and rays are dealt out among the lamps of a few surfaces at a time: which lamps
// get them must not depend on how the others shine, or light would not add up.
//
// Irradiance from a polygon: Lambert 1760, as in Baum, Rushmeier and Winget 1989. Trees of lights: Walter, Fernandez,
// Arbree, Bala, Donikian and Greenberg. Lightcuts: A Scalable Approach to Illumination. 2005
#pragma once

#include <algorithm>
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
  Rgb irradiance{0.0F};  ///< what it and its group bring unoccluded, over the odds of having chosen them, lx
};

/// The lamps as one point weighs them. Reused from point to point.
struct LampWeights {
  struct Entry {
    double until;         // sum of weights up to and with this entry
    std::uint32_t group;  // of one lamp or of many
  };
  std::vector<Entry> entries;
  double total = 0.0;  ///< irradiance of all lamps unoccluded, weighted by their brightness
};

/// With more surfaces that emit, the last of them share their rays.
inline constexpr std::uint32_t kMaxDeals = 16;

/// Immutable; may be shared between threads.
class Lamps {
 public:
  /// A point within `surface_offset` (m) of a lamp's plane sees it edge-on and gets nothing from it.
  Lamps(std::span<const EmissiveTile> tiles, float surface_offset);

  bool empty() const { return tiles_.empty(); }
  const EmissiveTile& tile(std::uint32_t lamp) const { return tiles_[lamp]; }

  /// How many times rays are dealt out, each time among other lamps.
  std::uint32_t deal_count() const { return std::min(static_cast<std::uint32_t>(roots_.size()), kMaxDeals); }

  /// REQUIRES: deal < deal_count().
  void weigh(const SurfacePoint& point, std::uint32_t deal, LampWeights& weights) const;
  /// The lamp at `along` in [0, 1) of the sum of weights. REQUIRES: weights.total > 0.
  ChosenLamp choose(const LampWeights& weights, double along) const;

 private:
  /// A node of the tree. Its lamps are neighbours in `tiles_`; the first child comes next in `groups_`.
  struct Group {
    std::uint32_t first = 0, count = 0;
    std::uint32_t second_child = 0;
    glm::vec3 middle{0.0F};  // m, weighted by flux
    float radius = 0.0F;     // m, of a sphere around the middle that holds all lamps
    float thickness = 0.0F;  // m, corners are no further from the plane through the middle across `facing`
    glm::vec3 facing{0.0F};  // mean normal, weighted by flux: shorter than 1 where the group is curved
    double flux = 0.0;       // sum of area times brightness
    Rgb color{0.0F};         // mean luminance over mean brightness
    bool two_sided = false;
  };

  /// What a point sees of a group without opening it.
  struct FarView {
    enum Share : std::uint8_t { kHidden, kUnclear, kInView } share;
    double weight;  // irradiance of the whole, by its brightness
  };

  std::uint32_t build(std::uint32_t first, std::uint32_t count);
  Group describe(std::uint32_t first, std::uint32_t count) const;
  FarView view_from_afar(const Group& group, const SurfacePoint& point) const;
  double weight_of_lamp(std::uint32_t lamp, const SurfacePoint& point) const;

  std::vector<EmissiveTile> tiles_;
  float surface_offset_;
  std::vector<Group> groups_;         // tree by tree, roots first
  std::vector<std::uint32_t> roots_;  // in groups_, a tree for each surface
  std::vector<double> flux_until_;    // [lamp_count + 1]: flux of all lamps before
  std::vector<float> reach2_;         // per lamp: squared distance (m2) beyond which it counts as a point
};

}  // namespace radiosity
