#include "core/emitters.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/photometry.h"

namespace radiosity {

namespace {

float brightness(const Scene& scene, std::uint32_t triangle, Emitters::By by) {
  if (by == Emitters::By::kFlux) return luminance_of(shown_emission(scene, triangle, {}));
  const Surface& surface = scene.surfaces[scene.surface_of_triangle[triangle]];
  const float whole = undyed_brightness(surface, surface.emission);
  return undyed_brightness(surface, mean_emission(scene, triangle, {})) / (whole > 0.0F ? whole : 1.0F);
}

}  // namespace

Emitters::Emitters(const Scene& scene, By by) {
  // What sends how much.
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const double area = 0.5 * static_cast<double>(glm::length(scaled_normal(scene, t)));
    const double luminance = static_cast<double>(brightness(scene, t, by));
    const double sides = scene.surfaces[scene.surface_of_triangle[t]].two_sided ? 2.0 : 1.0;
    const double flux = sides * luminance * area;
    if (!(flux > 0.0)) continue;
    triangles_.push_back(t);
    cumulative_flux_.push_back(flux + (cumulative_flux_.empty() ? 0.0 : cumulative_flux_.back()));
    density_.resize(scene.triangles.size(), 0.0F);
    density_[t] = static_cast<float>(sides * luminance);
  }
  if (triangles_.empty()) return;

  // A triangle's share of the flux over its area.
  const auto scale = static_cast<float>(1.0 / cumulative_flux_.back());
  for (float& density : density_) density *= scale;
}

EmitterPlace Emitters::choose(Random& random) const {
  const double flux = static_cast<double>(random.share()) * cumulative_flux_.back();
  const auto chosen = std::upper_bound(cumulative_flux_.begin(), cumulative_flux_.end() - 1, flux);
  return {triangles_[static_cast<std::size_t>(chosen - cumulative_flux_.begin())], random_place(random)};
}

}  // namespace radiosity
