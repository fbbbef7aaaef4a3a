// Small display meshes in code, and parts of triangles.
#pragma once

#include <cstdint>

#include "core/mesh/refined_mesh.h"

namespace radiosity::test {

/// Adds a grid of n x n quads, each of two triangles, between `origin`, `origin + u` and `origin + v`.
void add_grid(RefinedMesh& mesh, int n, const glm::vec3& origin, const glm::vec3& u, const glm::vec3& v);

/// The unit square of z = 0 as such a grid.
RefinedMesh grid(int n);

glm::vec3 middle(const RefinedMesh& mesh, std::uint32_t element);

/// In barycentric coordinates: half for a whole triangle, negative for one that runs clockwise.
double area_of(const SubTriangle& part);

/// Whether `part` holds a point, give or take rounding.
bool holds(const SubTriangle& part, Barycentrics at);

}  // namespace radiosity::test
