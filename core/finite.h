// Whether numbers can be computed with.
#pragma once

#include <cmath>
#include <glm/vec3.hpp>

namespace radiosity {

/// The largest coordinate that a scene may have, m. Beyond it the fourth powers that squared areas are made of are no
/// floats any more, and rays without a length stop Embree.
inline constexpr float kMaxCoordinate = 1e8F;

inline bool is_finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Whether scenes may have something there. False for what is not finite.
inline bool is_in_reach(const glm::vec3& v) {
  return std::abs(v.x) <= kMaxCoordinate && std::abs(v.y) <= kMaxCoordinate && std::abs(v.z) <= kMaxCoordinate;
}

}  // namespace radiosity
