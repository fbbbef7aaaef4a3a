// What a bake leaves behind so that other lights can be tried: all that does not depend on how bright the light is.
//
// Light adds up and its bands do not mix. So the light that each light group brings to the vertices, times a dimmer per
// band, is all that other lights take: a weighted sum. Where surfaces reflect otherwise the exchange must be solved
// anew, over rows of F that are known, and gathered anew, by hemicubes whose cells are known.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/light_groups.h"
#include "core/mesh/patches.h"
#include "core/reconstruct/fit_vertices.h"
#include "core/reconstruct/sample_log.h"
#include "core/reconstruct/samples.h"
#include "core/rgb.h"
#include "core/transport/form_factors.h"
#include "core/visibility/hemicube.h"

namespace radiosity {

/// Views of what others own. Light of groups is before it is dimmed. A *value* is what a smooth group's vertices share.
struct LightTransport {
  std::uint32_t group_count = 0;
  LightParts parts = LightParts::kBoth;

  // For other lights.
  std::span<const std::uint32_t> value_of_vertex;  ///< [vertex_count]
  std::span<const Rgb> fits;                       ///< of each group, perhaps negative, lx, [group_count * value_count]
  std::span<const glm::uvec3> fit_values;          ///< the values at the corners of each element, [fit_element_count]
  std::span<const float> fit_shares;               ///< and its share of the fit's matrix, [fit_element_count * 6]

  // For other reflectances. All empty where that would have taken too much memory.
  std::span<const std::uint64_t> row_begin;       ///< of F, [patch_count + 1]
  std::span<const std::uint32_t> row_patch;       ///< columns
  std::span<const float> row_factor;              ///< F_ij
  std::span<const std::uint32_t> surface;         ///< of each patch
  std::span<const Rgb> reflectance;               ///< of each patch
  std::span<const Rgb> undyed;                    ///< the same if its material's factor were white
  std::span<const Rgb> glow;                      ///< of each patch, cd/m2
  std::span<const std::uint32_t> glow_group;      ///< of each patch
  std::span<const Rgb> patch_direct;              ///< [patch_count * group_count], lx
  std::span<const std::uint32_t> sample_element;  ///< which fit element each sample lies in
  std::span<const glm::vec3> sample_weight;       ///< of its corners, times the area that the sample stands for
  std::span<const Rgb> sample_direct;             ///< [sample_count * group_count], lx
  std::span<const float> cell_factor;             ///< delta form factors, [cell_count]
  std::span<const std::uint32_t> cell_patch;      ///< what they see, or kNothing, [sample_count * cell_count]

  std::size_t value_count() const { return group_count == 0 ? 0 : fits.size() / group_count; }
  bool has_rows() const { return !row_begin.empty(); }
};

/// The same, owned.
struct KeptTransport {
  std::uint32_t group_count = 0;
  LightParts parts = LightParts::kBoth;
  std::vector<std::uint32_t> value_of_vertex;
  std::vector<Rgb> fits;
  std::vector<glm::uvec3> fit_values;
  std::vector<float> fit_shares;
  std::vector<std::uint64_t> row_begin;
  std::vector<std::uint32_t> row_patch;
  std::vector<float> row_factor;
  std::vector<std::uint32_t> surface;
  std::vector<Rgb> reflectance, undyed, glow;
  std::vector<std::uint32_t> glow_group;
  std::vector<Rgb> patch_direct;
  std::vector<std::uint32_t> sample_element;
  std::vector<glm::vec3> sample_weight;
  std::vector<Rgb> sample_direct;
  std::vector<float> cell_factor;
  std::vector<std::uint32_t> cell_patch;

  LightTransport view() const;
};

/// The part that other lights take.
void keep_fits(const VertexFit& fit, std::span<const std::vector<glm::dvec3>> fits, KeptTransport& kept);

/// What patches are and how they exchange light. `direct` as KeptTransport::patch_direct. False, and nothing is kept,
/// if a row is not at hand.
bool keep_exchange(const Scene& scene, const Patches& patches, const RowCache& rows, std::span<const Rgb> direct,
                   KeptTransport& kept);

/// What samples see. False, and nothing is kept, if the log has no cells.
bool keep_samples(const RefinedMesh& mesh, const Samples& samples, const SampleLog& log, const Hemicube& hemicube,
                  KeptTransport& kept);

/// Forgets what keep_exchange() and keep_samples() kept.
void forget_rows(KeptTransport& kept);

}  // namespace radiosity
