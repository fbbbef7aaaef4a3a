// Directions towards the sky, in proportion to the light that comes from them.
//
// For estimators that send rays one by one; a pdf for every direction lets them be combined with other choices of
// direction. First a row, then a texel in it, then a place in the texel: each by its share of what is left.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <vector>

#include "core/sky.h"

namespace radiosity {

struct SkySample {
  glm::vec3 direction{0.0F};  ///< unit, world space
  Rgb luminance{0.0F};        ///< of the sky in that direction, cd/m2
  float pdf = 0.0F;           ///< 1/sr; 0 if the sky is black
};

/// Immutable; may be shared between threads.
class SkySampler {
 public:
  /// `sky` must outlive the sampler.
  explicit SkySampler(const Sky& sky);

  /// The direction for a place in [0,1)^2; neighbouring places mostly give neighbouring directions.
  SkySample sample(const glm::vec2& place) const;
  /// Density of sample() in a direction (unit, world space), 1/sr.
  float pdf(const glm::vec3& direction) const;
  /// Whether nothing comes from anywhere.
  bool is_black() const { return !(total_ > 0.0); }

 private:
  const Sky& sky_;
  double total_ = 0.0;              // eye-weighted luminance over the sphere, cd sr/m2
  std::vector<double> row_until_;   // per row: share of all rows up to and with it
  std::vector<float> texel_until_;  // per texel: share of its row up to and with it
};

}  // namespace radiosity
