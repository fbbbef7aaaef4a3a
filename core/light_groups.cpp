#include "core/light_groups.h"

#include <glm/common.hpp>

#include "core/photometry.h"
#include "core/reconstruct/fit_vertices.h"
#include "core/reconstruct/group_light.h"
#include "core/reconstruct/interpolate_vertices.h"

namespace radiosity {
namespace {

/// Values of smooth groups at the vertices, negative ones too.
std::vector<Rgb> at_vertices(const SmoothGroups& groups, std::span<const glm::dvec3> value) {
  std::vector<Rgb> light;
  light.reserve(groups.group_of_vertex.size());
  for (const std::uint32_t group : groups.group_of_vertex) light.emplace_back(value[group]);
  return light;
}

}  // namespace

Rgb sent_part(const Rgb& radiosity, const Rgb& glow, LightParts parts) {
  if (parts == LightParts::kBoth) return radiosity;
  const Rgb exitance = exitance_of_luminance(glow);
  return parts == LightParts::kDirect ? exitance : glm::max(radiosity - exitance, Rgb(0.0F));
}

void add_sky(std::span<const Rgb> sky_light, const Scene& scene, std::vector<Rgb>& direct, std::vector<Rgb>& by_group) {
  const std::size_t group_count = direct.empty() ? 0 : by_group.size() / direct.size();
  const Rgb dimmer = dimmer_of(scene, scene.sky.light_group);
  for (std::size_t i = 0; i < sky_light.size(); ++i) {
    direct[i] += sky_light[i] * dimmer;
    if (group_count > 0) by_group[i * group_count + scene.sky.light_group] += sky_light[i];
  }
}

std::vector<std::uint32_t> glow_groups(const Scene& scene, const Patches& patches) {
  std::vector<std::uint32_t> groups;
  groups.reserve(patches.surface.size());
  for (const std::uint32_t surface : patches.surface) groups.push_back(scene.surfaces[surface].light_group);
  return groups;
}

std::vector<Rgb> dimmers_of(const Scene& scene, std::uint32_t group_count) {
  std::vector<Rgb> dimmers;
  for (std::uint32_t g = 0; g < group_count; ++g) dimmers.push_back(dimmer_of(scene, g));
  return dimmers;
}

GroupFits fit_groups(const DisplayMesh& display, const SampleLog& log, const Samples& samples) {
  const RefinedMesh& mesh = display.mesh();
  GroupFits fits{make_vertex_fit(mesh, samples, fit_options(display)), {}};
  for (std::uint32_t g = 0; g < log.group_count; ++g) {
    fits.values.push_back(fit_freely(mesh, samples, fits.fit, light_of_group(log, samples, g)));
  }
  return fits;
}

std::vector<std::vector<Rgb>> light_of_groups(const Scene& scene, const GroupFits& fits,
                                              std::span<const Rgb> irradiance) {
  std::vector<std::vector<Rgb>> free;
  for (const std::vector<glm::dvec3>& value : fits.values) free.push_back(at_vertices(fits.fit.groups, value));
  const auto group_count = static_cast<std::uint32_t>(free.size());
  return share_among_groups(irradiance, std::move(free), dimmers_of(scene, group_count));
}

std::vector<std::vector<Rgb>> light_of_groups(const Scene& scene, const DisplayMesh& display, const SampleLog& log,
                                              const Reconstruction& light) {
  std::vector<std::vector<Rgb>> free;
  for (std::uint32_t g = 0; g < log.group_count; ++g) {
    const std::vector<Rgb> of_group = light_of_group(log, light.samples, g);
    free.push_back(interpolate_vertices(display.mesh(), mean_of_samples(light.samples, of_group)));
  }
  return share_among_groups(light.irradiance, std::move(free), dimmers_of(scene, log.group_count));
}

}  // namespace radiosity
