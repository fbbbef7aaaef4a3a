// What must hold of every display mesh, however it was cut.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/mesh/refined_mesh.h"
#include "core/scene.h"

namespace radiosity::test {

/// Triangles of one grey surface, shaded flat.
Scene scene_of(std::vector<glm::vec3> positions, std::vector<glm::uvec3> triangles);

/// `count` triangles around the origin, in the plane z = 0.
Scene fan(std::uint32_t count);

std::size_t t_vertex_count(const RefinedMesh& mesh);

/// Checks all that must hold for every scene whatever its faults.
///
/// The parts of a triangle tile it without gap or overlap (exactly: their coordinates are dyadic); every inner edge has
/// two elements; and all triangles that share an edge's two end positions carry the same points on it. Together these
/// leave no room for a T-vertex.
void expect_conforming(const Scene& scene, const RefinedMesh& mesh);

}  // namespace radiosity::test
