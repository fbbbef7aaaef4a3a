// What both users of OpenMesh share: the mesh type, and how triangles are entered. Only for openmesh_bridge.cpp and
// collapse_net.cpp.
#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace radiosity {

using OpenMeshTriangles = OpenMesh::TriMesh_ArrayKernelT<>;

inline std::uint32_t number_of(const OpenMesh::BaseHandle& handle) { return static_cast<std::uint32_t>(handle.idx()); }

inline OpenMeshTriangles::Point point_of(const glm::vec3& position) { return {position.x, position.y, position.z}; }

/// OpenMesh reports each triangle it refuses; here that is expected, and core does not print.
inline void silence_openmesh() {
  static const bool silent = [] {
    omerr().disable();
    omout().disable();
    omlog().disable();
    return true;
  }();
  static_cast<void>(silent);
}

/// Enters triangles on given vertices, where OpenMesh takes them.
class Joiner {
 public:
  explicit Joiner(std::size_t vertex_count) : joined_at_vertex_(vertex_count, 0) {}

  /// An invalid handle if the triangle is refused: the third at an edge, a neighbour wound the other way, a duplicate
  /// or its back, one that names a vertex twice, or one more at a vertex that has very many.
  OpenMesh::FaceHandle add(OpenMeshTriangles& mesh, const std::array<OpenMesh::VertexHandle, 3>& corners) {
    const auto [a, b, c] = corners;
    if (a == b || b == c || c == a) return OpenMesh::FaceHandle();
    for (const OpenMesh::VertexHandle vertex : corners) {
      if (joined_at_vertex_[number_of(vertex)] >= kMostJoinedAtVertex) return OpenMesh::FaceHandle();
    }
    // Two triangles back to back would be a closed surface to OpenMesh, but one in which edges cannot be turned.
    const auto back = mesh.find_halfedge(b, a);
    if (back.is_valid() && !back.is_boundary() && back.next().to() == c) return OpenMesh::FaceHandle();
    const OpenMesh::FaceHandle face(mesh.add_face(a, b, c).idx());
    for (const OpenMesh::VertexHandle vertex : corners) {
      joined_at_vertex_[number_of(vertex)] += face.is_valid() ? 1U : 0U;
    }
    return face;
  }

 private:
  /// More are entered on vertices of their own. OpenMesh walks around a vertex for each triangle it adds there: 20 000
  /// in a fan, in any order, took 6 s, and take 0.1 s so.
  static constexpr std::uint32_t kMostJoinedAtVertex = 256;

  std::vector<std::uint32_t> joined_at_vertex_;  ///< triangles entered so far
};

}  // namespace radiosity
