// Samples inside elements -> light at vertices, by least squares.
//
// The light that is displayed is linear within each element. Among all such functions this one is closest to the
// samples, in the sense of the area-weighted mean square, plus a little smoothness that decides where there are none:
//
//     sum over samples of w_s (x(s) - H_s)^2  +  damping * sum over elements of area * (differences along edges)^2
//
// Kavan, Bargteil and Sloan. Least Squares Vertex Baking. 2011
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/mesh/refined_mesh.h"
#include "core/reconstruct/fit_system.h"
#include "core/reconstruct/samples.h"
#include "core/reconstruct/smooth_groups.h"

namespace radiosity {

struct FitOptions {
  double damping = 0.02;     ///< weight of smoothness against samples, > 0
  bool fades = false;        ///< smoothness loses its say where an element has more than three samples
  int max_iterations = 200;  ///< of the conjugate gradients
};

/// Irradiance at each vertex, [vertex_count], lx, never negative. Vertices of a smooth group (smooth_groups.h) share a
/// value; nothing crosses a crease. The area-weighted mean of the samples is kept, up to the share that would be
/// negative. Vertices without samples around them continue their neighbours; what nothing known is joined to is black.
/// `guess` [vertex_count], or empty, is where the iteration starts: a fit of the same mesh before it was cut.
std::vector<Rgb> fit_vertices(const RefinedMesh& mesh, const Samples& samples, const FitOptions& options,
                              std::span<const Rgb> guess = {});

/// What a fit does with light, whatever light it is.
struct VertexFit {
  SmoothGroups groups;
  FitMatrix matrix;  ///< over these groups
};
VertexFit make_vertex_fit(const RefinedMesh& mesh, const Samples& samples, const FitOptions& options);

/// The fit to other light of the same samples, [sample_count], not cut off at zero: the fits to two lights add up to
/// the fit to both. Per smooth group.
std::vector<glm::dvec3> fit_freely(const RefinedMesh& mesh, const Samples& samples, const VertexFit& fit,
                                   std::span<const Rgb> irradiance);

/// Values of smooth groups at the vertices, none below zero.
std::vector<Rgb> of_vertices(std::span<const std::uint32_t> group_of_vertex, std::span<const glm::dvec3> value);

}  // namespace radiosity
