// What a bake does to keep the light of each light group apart.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/display_mesh.h"
#include "core/mesh/patches.h"
#include "core/reconstruct/reconstruct.h"
#include "core/reconstruct/sample_log.h"
#include "core/scene.h"

namespace radiosity {

/// What of the light at a vertex is wanted: what comes straight from lamps, lights and sky, what surfaces reflect.
enum class LightParts : std::uint8_t { kBoth, kDirect, kIndirect };

/// What patches send to the points where light is gathered, lm/m2: glow is a source, the rest is reflected.
Rgb sent_part(const Rgb& radiosity, const Rgb& glow, LightParts parts);

/// Adds sky light, [patch_count] or empty, to the direct light of patches, dimmed, and to that of the sky's group in
/// `by_group` [patch_count * group_count], which may be empty.
void add_sky(std::span<const Rgb> sky_light, const Scene& scene, std::vector<Rgb>& direct, std::vector<Rgb>& by_group);

/// The group that the glow of each patch belongs to, [patch_count].
std::vector<std::uint32_t> glow_groups(const Scene& scene, const Patches& patches);

/// The dimmer of each of `group_count` groups.
std::vector<Rgb> dimmers_of(const Scene& scene, std::uint32_t group_count);

/// How light of samples becomes light at vertices, and what it makes of each group: not cut off at zero, per smooth
/// group of vertices.
struct GroupFits {
  VertexFit fit;
  std::vector<std::vector<glm::dvec3>> values;
};
GroupFits fit_groups(const DisplayMesh& display, const SampleLog& log, const Samples& samples);

/// The light of each group at the vertices, as Bake::group_irradiance has it, from fits or by interpolation.
std::vector<std::vector<Rgb>> light_of_groups(const Scene& scene, const GroupFits& fits,
                                              std::span<const Rgb> irradiance);
std::vector<std::vector<Rgb>> light_of_groups(const Scene& scene, const DisplayMesh& display, const SampleLog& log,
                                              const Reconstruction& light);

}  // namespace radiosity
