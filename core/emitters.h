// Emissive triangles as random paths aim at them: chosen in proportion to the flux that they send out.
//
// The direct light of a bake knows nothing of it: transport/lamps.h.
#pragma once

#include <cstdint>
#include <vector>

#include "core/random.h"
#include "core/scene.h"

namespace radiosity {

/// A place on an emissive triangle.
struct EmitterPlace {
  std::uint32_t triangle = kNothing;
  Barycentrics at{0.0F};
};

/// Immutable once built, thread-safe. The scene must outlive it.
class Emitters {
 public:
  /// What a triangle's chance is in proportion to: its flux, or what that would be if all surfaces were equally bright
  /// and white, so that the choice does not depend on how they are coloured and dimmed.
  enum class By : std::uint8_t { kFlux, kEqualFlux };

  explicit Emitters(const Scene& scene, By by = By::kFlux);

  bool empty() const { return triangles_.empty(); }

  /// A triangle in proportion to its flux, a place on it in proportion to area. REQUIRES: not empty().
  EmitterPlace choose(Random& random) const;

  /// How densely choose() covers a triangle, 1/m2; 0 where it never goes.
  float density(std::uint32_t triangle) const { return density_.empty() ? 0.0F : density_[triangle]; }

 private:
  std::vector<std::uint32_t> triangles_;
  std::vector<double> cumulative_flux_;  ///< [triangles_.size()], up to and with each; in units of lm / pi
  std::vector<float> density_;           ///< [triangle_count], or empty where nothing emits
};

}  // namespace radiosity
