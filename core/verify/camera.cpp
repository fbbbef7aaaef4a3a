#include "core/verify/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "core/random.h"

namespace radiosity {
namespace {

constexpr int kProbes = 256;
constexpr int kMaxCulled = 1000;  ///< backs that one ray may pass

/// What a viewer at a place is surrounded by.
struct Surroundings {
  double closed = 0.0;    ///< share of directions where something is hit
  double backs = 0.0;     ///< share of directions where the first is a back that is not shown
  double distance = 0.0;  ///< mean over the hits, metres
};

Surroundings look_around(const RayScene& rays, const glm::vec3& eye) {
  Surroundings result;
  Random random(1, 0);
  int hits = 0;
  for (int i = 0; i < kProbes; ++i) {
    const float y = 1.0F - (2.0F * static_cast<float>(i) + 1.0F) / kProbes;
    const float radius = std::sqrt(1.0F - y * y);
    const float angle = 2.39996323F * static_cast<float>(i);  // golden angle: a spiral over the sphere
    const Ray ray{eye, {radius * std::cos(angle), y, radius * std::sin(angle)}};
    const std::optional<Hit> hit = nearest_hit(rays, ray, [&random] { return random.share(); });
    if (!hit) continue;
    ++hits;
    const Scene& scene = rays.scene();
    const bool two_sided = scene.surfaces[scene.surface_of_triangle[hit->triangle]].two_sided;
    result.backs += hit->back && !two_sided ? 1.0 / kProbes : 0.0;
    result.distance += static_cast<double>(hit->distance);
  }
  result.closed = static_cast<double>(hits) / kProbes;
  result.distance /= std::max(hits, 1);
  return result;
}

struct Box {
  glm::vec3 low{0.0F}, high{0.0F};
  glm::vec3 middle() const { return 0.5F * (low + high); }
  glm::vec3 size() const { return high - low; }
};

Box box_of(const Scene& scene) {
  if (scene.positions.empty()) return {};
  Box box{scene.positions.front(), scene.positions.front()};
  for (const glm::vec3& position : scene.positions) {
    box.low = glm::min(box.low, position);
    box.high = glm::max(box.high, position);
  }
  return box;
}

/// Whether the walls towards a viewer outside hide what is inside: they are seen from both sides.
bool is_hidden(const RayScene& rays, const View& outside) {
  const Camera camera = make_camera(outside, 50.0F, 1.0F);
  Random random(1, 1);
  const float step = surface_offset(rays.scene());
  int hits = 0;
  int two_sided = 0;
  for (int i = 0; i < kProbes; ++i) {
    const Ray ray = camera.ray(2.0F * random.share() - 1.0F, 2.0F * random.share() - 1.0F);
    const std::optional<Hit> hit = nearest_seen(rays, ray, step, [&random] { return random.share(); });
    if (!hit) continue;
    const Scene& scene = rays.scene();
    ++hits;
    two_sided += scene.surfaces[scene.surface_of_triangle[hit->triangle]].two_sided ? 1 : 0;
  }
  return 3 * two_sided > hits;
}

}  // namespace

Ray Camera::ray(float x, float y) const { return {eye, glm::normalize(forward + x * right + y * up)}; }

Camera make_camera(const View& view, float fov_degrees, float aspect) {
  Camera camera;
  camera.eye = view.eye;
  camera.forward = glm::normalize(view.at - view.eye);
  const glm::vec3 sky = std::abs(camera.forward.y) > 0.99F ? glm::vec3(0.0F, 0.0F, 1.0F) : glm::vec3(0.0F, 1.0F, 0.0F);
  const glm::vec3 right = glm::normalize(glm::cross(camera.forward, sky));
  const float half = std::tan(0.5F * glm::radians(fov_degrees));
  camera.right = half * aspect * right;
  camera.up = half * glm::cross(right, camera.forward);
  return camera;
}

View default_view(const RayScene& rays) {
  // From outside.
  const Box box = box_of(rays.scene());
  const View outside{box.middle() + 0.9F * box.size(), box.middle()};
  constexpr double kClosed = 0.9;
  constexpr double kFewBacks = 0.1;
  if (!(look_around(rays, box.middle()).closed > kClosed) || !is_hidden(rays, outside)) return outside;

  // From inside: near one of the upper corners, the one with the widest view.
  View best = outside;
  double best_distance = 0.0;
  for (const glm::vec3 towards : {glm::vec3(1, 1, 1), glm::vec3(-1, 1, 1), glm::vec3(1, 1, -1), glm::vec3(-1, 1, -1)}) {
    const glm::vec3 eye = box.middle() + glm::vec3(0.35F, 0.15F, 0.35F) * towards * box.size();
    const Surroundings around = look_around(rays, eye);
    if (around.closed < kClosed || around.backs > kFewBacks || around.distance <= best_distance) continue;
    best = {eye, box.middle() - glm::vec3(0.0F, 0.1F, 0.0F) * box.size()};
    best_distance = around.distance;
  }
  return best;
}

std::optional<Hit> nearest_seen(const RayScene& rays, Ray ray, float step, const DrawThreshold& threshold) {
  const Scene& scene = rays.scene();
  float passed = 0.0F;
  for (int culled = 0; culled < kMaxCulled; ++culled) {
    std::optional<Hit> hit = nearest_hit(rays, ray, threshold);
    if (!hit) return std::nullopt;
    if (!hit->back || scene.surfaces[scene.surface_of_triangle[hit->triangle]].two_sided) {
      hit->distance += passed;
      return hit;
    }
    passed += hit->distance + step;
    ray.from += (hit->distance + step) * ray.direction;
  }
  return std::nullopt;
}

}  // namespace radiosity
