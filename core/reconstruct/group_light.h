// The light of each light group at the vertices.
//
// Fits add up before they are cut off at zero, so groups are fitted freely; what the whole shows after the cut is then
// shared among them in proportion. So the groups add up to the whole at every vertex, and none is negative.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/mesh/refined_mesh.h"
#include "core/reconstruct/fit_vertices.h"
#include "core/reconstruct/sample_log.h"
#include "core/reconstruct/samples.h"

namespace radiosity {

/// Light of one light group at the samples, before it is dimmed, lx, [sample_count].
std::vector<Rgb> light_of_group(const SampleLog& log, const Samples& samples, std::size_t group);

/// `whole`, the light of all groups at the vertices, [vertex_count], in parts: [group_count][vertex_count], none
/// negative, before they are dimmed: times `dimmers` [group_count] they add up to the whole. `free` are those that
/// a fit gives each group, likewise before they are dimmed and perhaps negative.
std::vector<std::vector<Rgb>> share_among_groups(std::span<const Rgb> whole, std::vector<std::vector<Rgb>> free,
                                                 std::span<const Rgb> dimmers);

}  // namespace radiosity
