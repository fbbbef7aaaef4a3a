// Whether numbers can be computed with.
#pragma once

#include <cmath>
#include <glm/vec3.hpp>

namespace radiosity {

inline bool is_finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace radiosity
