#include "core/mesh/collapse_net.h"

#include <array>

#include "core/mesh/openmesh_join.h"
#include "core/scene.h"

namespace radiosity {
namespace {

OpenMesh::VertexHandle vertex_of(std::uint32_t number) { return OpenMesh::VertexHandle(static_cast<int>(number)); }

/// Whether only one element would be left around `vertex`, back to back with one that is there: OpenMesh minds no such
/// pair.
bool would_be_back_to_back(const OpenMeshTriangles& mesh, OpenMesh::HalfedgeHandle along) {
  const OpenMesh::HalfedgeHandle back = mesh.opposite_halfedge_handle(along);
  if (mesh.valence(mesh.from_vertex_handle(along)) != 3 || mesh.is_boundary(along) || mesh.is_boundary(back)) {
    return false;
  }
  const OpenMesh::HalfedgeHandle rim = mesh.find_halfedge(mesh.to_vertex_handle(mesh.next_halfedge_handle(along)),
                                                          mesh.to_vertex_handle(mesh.next_halfedge_handle(back)));
  if (!rim.is_valid()) return false;
  const auto has_end = [&](OpenMesh::HalfedgeHandle side) {
    return !mesh.is_boundary(side) &&
           mesh.to_vertex_handle(mesh.next_halfedge_handle(side)) == mesh.to_vertex_handle(along);
  };
  return has_end(rim) || has_end(mesh.opposite_halfedge_handle(rim));
}

}  // namespace

struct CollapseNet::Net {
  OpenMeshTriangles mesh;
  std::vector<std::uint32_t> element_of_face;
  std::vector<std::uint8_t> fixed;  // [class_count]
};

CollapseNet::CollapseNet(std::span<const glm::uvec3> elements, std::span<const std::uint32_t> class_of_vertex,
                         std::uint32_t class_count)
    : net_(std::make_unique<Net>()) {
  silence_openmesh();
  OpenMeshTriangles& mesh = net_->mesh;
  mesh.request_vertex_status();
  mesh.request_halfedge_status();
  mesh.request_edge_status();
  mesh.request_face_status();
  mesh.reserve(class_count, elements.size() * 3 / 2, elements.size());
  for (std::uint32_t i = 0; i < class_count; ++i) mesh.add_vertex(OpenMeshTriangles::Point(0.0F));
  net_->fixed.assign(class_count, 0);

  // What is refused is not in the net; it holds its corners.
  Joiner joiner(class_count);
  net_->element_of_face.reserve(elements.size());
  for (std::uint32_t e = 0; e < elements.size(); ++e) {
    std::array<OpenMesh::VertexHandle, 3> corners;
    for (int k = 0; k < 3; ++k) corners[static_cast<std::size_t>(k)] = vertex_of(class_of_vertex[elements[e][k]]);
    if (joiner.add(mesh, corners).is_valid()) {
      net_->element_of_face.push_back(e);
    } else {
      for (const OpenMesh::VertexHandle corner : corners) net_->fixed[number_of(corner)] = 1;
    }
  }
  for (const OpenMesh::VertexHandle vertex : mesh.vertices()) {
    if (mesh.is_isolated(vertex) || !mesh.is_manifold(vertex)) net_->fixed[number_of(vertex)] = 1;
  }
}

CollapseNet::~CollapseNet() = default;

std::uint32_t CollapseNet::edge_count() const { return static_cast<std::uint32_t>(net_->mesh.n_edges()); }

bool CollapseNet::is_fixed(std::uint32_t vertex) const { return net_->fixed[vertex] != 0; }

void CollapseNet::find_spokes(std::uint32_t vertex, std::vector<Spoke>& spokes) const {
  const OpenMeshTriangles& mesh = net_->mesh;
  spokes.clear();
  const OpenMesh::HalfedgeHandle first = mesh.halfedge_handle(vertex_of(vertex));
  OpenMesh::HalfedgeHandle spoke = first;
  do {
    const OpenMesh::FaceHandle face = mesh.face_handle(spoke);
    spokes.push_back({number_of(mesh.to_vertex_handle(spoke)), number_of(mesh.edge_handle(spoke)),
                      face.is_valid() ? net_->element_of_face[number_of(face)] : kNothing});
    spoke = mesh.next_halfedge_handle(mesh.opposite_halfedge_handle(spoke));
  } while (spoke != first);
}

std::uint32_t CollapseNet::edge_between(std::uint32_t from, std::uint32_t to) const {
  const OpenMeshTriangles& mesh = net_->mesh;
  return number_of(mesh.edge_handle(mesh.find_halfedge(vertex_of(from), vertex_of(to))));
}

bool CollapseNet::collapse(std::uint32_t from, std::uint32_t to) {
  OpenMeshTriangles& mesh = net_->mesh;
  const OpenMesh::HalfedgeHandle along = mesh.find_halfedge(vertex_of(from), vertex_of(to));
  if (!along.is_valid() || !mesh.is_collapse_ok(along) || would_be_back_to_back(mesh, along)) return false;
  mesh.collapse(along);
  return true;
}

}  // namespace radiosity
