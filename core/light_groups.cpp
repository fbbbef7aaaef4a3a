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

std::vector<std::vector<Rgb>> light_of_groups(const Scene& scene, const DisplayMesh& display, const SampleLog& log,
                                              const Reconstruction& light, Fit fit) {
  const RefinedMesh& mesh = display.mesh();
  const VertexFit vertex_fit = make_vertex_fit(mesh, light.samples, fit_options(display));
  std::vector<std::vector<Rgb>> free;
  for (std::uint32_t g = 0; g < log.group_count; ++g) {
    const std::vector<Rgb> samples = light_of_group(log, light.samples, g);
    free.push_back(fit == Fit::kInterpolate
                       ? interpolate_vertices(mesh, mean_of_samples(light.samples, samples))
                       : at_vertices(vertex_fit.groups, fit_freely(mesh, light.samples, vertex_fit, samples)));
  }
  return share_among_groups(light.irradiance, std::move(free), dimmers_of(scene, log.group_count));
}

}  // namespace radiosity
