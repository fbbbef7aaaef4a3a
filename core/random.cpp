#include "core/random.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "core/photometry.h"

namespace radiosity {

glm::vec2 random_place(Random& random) {
  const float root = std::sqrt(random.share());
  const float second = random.share();
  return {root * (1.0F - second), root * second};
}

glm::vec3 cosine_direction(const glm::vec3& normal, Random& random) {
  const float height_squared = random.share();  // of the direction above the plane, 1 - sine^2
  const float angle = 2.0F * kPi * random.share();
  const float sine = std::sqrt(1.0F - height_squared);
  const glm::vec3 helper = std::abs(normal.x) > 0.9F ? glm::vec3(0.0F, 1.0F, 0.0F) : glm::vec3(1.0F, 0.0F, 0.0F);
  const glm::vec3 u = glm::normalize(glm::cross(helper, normal));
  const glm::vec3 v = glm::cross(normal, u);
  return glm::normalize(sine * std::cos(angle) * u + sine * std::sin(angle) * v + std::sqrt(height_squared) * normal);
}

}  // namespace radiosity
