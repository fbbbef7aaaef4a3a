#include "core/mesh/openmesh_bridge.h"

#include <algorithm>
#include <glm/common.hpp>
#include <tuple>
#include <vector>

#include "core/mesh/openmesh_join.h"

namespace radiosity {
namespace {

using Mesh = OpenMeshTriangles;
using OpenMesh::EdgeHandle;
using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

EdgeHandle edge_of(std::uint32_t edge) { return EdgeHandle(static_cast<int>(edge)); }

/// Squared length in double: equal for both directions, and finite for all finite positions.
double squared_length(const Mesh::Point& a, const Mesh::Point& b) {
  const OpenMesh::Vec3d along = OpenMesh::vector_cast<OpenMesh::Vec3d>(a) - OpenMesh::vector_cast<OpenMesh::Vec3d>(b);
  return along.sqrnorm();
}

}  // namespace

struct OpenMeshBridge::Net {
  /// The corner at the end of a halfedge, as the triangle left of the halfedge knows it.
  struct Corner {
    std::uint32_t vertex = kNothing;
    Barycentrics at{0.0F};
  };

  Mesh mesh;
  OpenMesh::HPropHandleT<Corner> corner;
  OpenMesh::FPropHandleT<std::uint32_t> triangle;
  OpenMesh::VPropHandleT<std::uint32_t> position_class;
  std::vector<std::uint32_t> vertices_in_class;

  /// Since the round began: edges that run inside a triangle from an old vertex to a midpoint, one per cut triangle.
  std::vector<EdgeHandle> cuts;
  std::uint32_t first_midpoint = 0;

  /// `at` comes by value: it may be a point of this mesh, whose points move when one is added.
  VertexHandle add_vertex(std::uint32_t its_class, Mesh::Point at) {
    const VertexHandle vertex(mesh.add_vertex(at).idx());
    mesh.property(position_class, vertex) = its_class;
    vertices_in_class.resize(std::max<std::size_t>(vertices_in_class.size(), its_class + std::size_t{1}));
    ++vertices_in_class[its_class];
    return vertex;
  }

  bool is_midpoint(VertexHandle vertex) const { return number_of(vertex) >= first_midpoint; }

  void add_triangle(const std::array<VertexHandle, 3>& joined, std::uint32_t number, const glm::uvec3& vertices,
                    Joiner& joiner) {
    FaceHandle face = joiner.add(mesh, joined);
    if (!face.is_valid()) {
      std::array<VertexHandle, 3> own;
      for (std::size_t i = 0; i < 3; ++i) {
        own[i] = add_vertex(mesh.property(position_class, joined[i]), mesh.point(joined[i]));
      }
      face = FaceHandle(mesh.add_face(own[0], own[1], own[2]).idx());
    }
    mesh.property(triangle, face) = number;

    // A face's first halfedge ends at its first corner.
    HalfedgeHandle halfedge = mesh.halfedge_handle(face);
    mesh.property(corner, halfedge) = {vertices.x, {0.0F, 0.0F}};
    halfedge = mesh.next_halfedge_handle(halfedge);
    mesh.property(corner, halfedge) = {vertices.y, {1.0F, 0.0F}};
    halfedge = mesh.next_halfedge_handle(halfedge);
    mesh.property(corner, halfedge) = {vertices.z, {0.0F, 1.0F}};
  }

  /// Whether the other diagonal of the quad around `cut` is to be preferred: it joins two midpoints, or it is shorter.
  /// Decides by positions alone, so that all copies of a triangle are cut alike.
  bool should_turn(EdgeHandle cut) const {
    const HalfedgeHandle halfedge = mesh.halfedge_handle(cut, 0);
    const HalfedgeHandle twin = mesh.halfedge_handle(cut, 1);
    VertexHandle old_end = mesh.to_vertex_handle(halfedge);
    VertexHandle midpoint = mesh.to_vertex_handle(twin);
    if (is_midpoint(old_end)) {
      std::swap(old_end, midpoint);
    }
    VertexHandle left = mesh.to_vertex_handle(mesh.next_halfedge_handle(halfedge));
    VertexHandle right = mesh.to_vertex_handle(mesh.next_halfedge_handle(twin));
    if (is_midpoint(left) == is_midpoint(right)) {
      return is_midpoint(left);
    }
    if (is_midpoint(left)) {
      std::swap(left, right);
    }
    const double kept = squared_length(mesh.point(old_end), mesh.point(midpoint));
    const double turned = squared_length(mesh.point(left), mesh.point(right));
    const auto place = [this](VertexHandle v) {
      return std::tuple(mesh.point(v)[0], mesh.point(v)[1], mesh.point(v)[2]);
    };
    return turned < kept || (turned == kept && place(left) < place(old_end));
  }

  /// Puts the other diagonal of the quad around `edge`, inside one triangle, in its place; false if there is such an
  /// edge already.
  bool turn(EdgeHandle edge) {
    const HalfedgeHandle halfedge = mesh.halfedge_handle(edge, 0);
    const HalfedgeHandle twin = mesh.halfedge_handle(edge, 1);
    const HalfedgeHandle to_left = mesh.next_halfedge_handle(halfedge);
    const HalfedgeHandle to_right = mesh.next_halfedge_handle(twin);
    if (!mesh.is_flip_ok(edge)) return false;
    mesh.flip(edge);
    mesh.property(corner, mesh.next_halfedge_handle(to_left)) = mesh.property(corner, to_right);
    mesh.property(corner, mesh.next_halfedge_handle(to_right)) = mesh.property(corner, to_left);
    return true;
  }
};

OpenMeshBridge::OpenMeshBridge(std::span<const glm::uvec3> triangles, std::span<const std::uint32_t> class_of_vertex,
                               std::span<const glm::vec3> position_of_class)
    : net_(std::make_unique<Net>()) {
  silence_openmesh();
  Net& net = *net_;
  net.mesh.add_property(net.corner);
  net.mesh.add_property(net.triangle);
  net.mesh.add_property(net.position_class);
  net.mesh.reserve(position_of_class.size(), triangles.size() * 3 / 2, triangles.size());

  for (std::uint32_t i = 0; i < position_of_class.size(); ++i) {
    net.add_vertex(i, point_of(position_of_class[i]));
  }
  Joiner joiner(position_of_class.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    std::array<VertexHandle, 3> joined;
    for (int c = 0; c < 3; ++c) {
      joined[static_cast<std::size_t>(c)] = VertexHandle(static_cast<int>(class_of_vertex[triangles[i][c]]));
    }
    net.add_triangle(joined, i, triangles[i], joiner);
  }
}

OpenMeshBridge::~OpenMeshBridge() = default;

std::uint32_t OpenMeshBridge::edge_count() const { return static_cast<std::uint32_t>(net_->mesh.n_edges()); }

std::uint32_t OpenMeshBridge::face_count() const { return static_cast<std::uint32_t>(net_->mesh.n_faces()); }

glm::uvec2 OpenMeshBridge::end_classes(std::uint32_t edge) const {
  const Net& net = *net_;
  const auto class_at = [&](unsigned int which) {
    return net.mesh.property(net.position_class,
                             net.mesh.to_vertex_handle(net.mesh.halfedge_handle(edge_of(edge), which)));
  };
  const auto [low, high] = std::minmax({class_at(0), class_at(1)});
  return {low, high};
}

bool OpenMeshBridge::may_have_copies(std::uint32_t edge) const {
  // Copies differ in a vertex at one end at least: OpenMesh joins two given vertices by one edge only.
  const glm::uvec2 ends = end_classes(edge);
  return net_->vertices_in_class[ends.x] > 1 || net_->vertices_in_class[ends.y] > 1;
}

std::uint32_t OpenMeshBridge::triangle_at(std::uint32_t edge, unsigned int side) const {
  const Net& net = *net_;
  const FaceHandle face = net.mesh.face_handle(net.mesh.halfedge_handle(edge_of(edge), side));
  return face.is_valid() ? net.mesh.property(net.triangle, face) : kNothing;
}

std::uint32_t OpenMeshBridge::element_at(std::uint32_t edge, unsigned int side) const {
  const FaceHandle face = net_->mesh.face_handle(net_->mesh.halfedge_handle(edge_of(edge), side));
  return face.is_valid() ? number_of(face) : kNothing;
}

std::array<std::uint32_t, 3> OpenMeshBridge::edges_of(std::uint32_t element) const {
  const Mesh& mesh = net_->mesh;
  const HalfedgeHandle first = mesh.halfedge_handle(FaceHandle(static_cast<int>(element)));
  return {number_of(mesh.edge_handle(first)), number_of(mesh.edge_handle(mesh.next_halfedge_handle(first))),
          number_of(mesh.edge_handle(mesh.prev_halfedge_handle(first)))};
}

std::uint32_t OpenMeshBridge::triangle_of(std::uint32_t element) const {
  return net_->mesh.property(net_->triangle, FaceHandle(static_cast<int>(element)));
}

glm::uvec2 OpenMeshBridge::vertices_at(std::uint32_t edge, unsigned int side) const {
  const Net& net = *net_;
  const HalfedgeHandle halfedge = net.mesh.halfedge_handle(edge_of(edge), side);
  const HalfedgeHandle before = net.mesh.prev_halfedge_handle(halfedge);
  return {net.mesh.property(net.corner, before).vertex, net.mesh.property(net.corner, halfedge).vertex};
}

void OpenMeshBridge::rename(std::uint32_t element, std::uint32_t old_vertex, std::uint32_t vertex) {
  Net& net = *net_;
  for (const HalfedgeHandle halfedge : net.mesh.fh_range(FaceHandle(static_cast<int>(element)))) {
    Net::Corner& corner = net.mesh.property(net.corner, halfedge);
    if (corner.vertex == old_vertex) corner.vertex = vertex;
  }
}

glm::uvec2 OpenMeshBridge::opposite_classes(std::uint32_t edge) const {
  const Net& net = *net_;
  const auto class_across = [&](unsigned int side) {
    const HalfedgeHandle halfedge = net.mesh.halfedge_handle(edge_of(edge), side);
    return net.mesh.property(net.position_class, net.mesh.to_vertex_handle(net.mesh.next_halfedge_handle(halfedge)));
  };
  return {class_across(0), class_across(1)};
}

bool OpenMeshBridge::turn(std::uint32_t edge) { return net_->turn(edge_of(edge)); }

void OpenMeshBridge::begin_round(std::size_t edges, std::size_t sides) {
  Mesh& mesh = net_->mesh;
  mesh.reserve(mesh.n_vertices() + edges, mesh.n_edges() + edges + sides, mesh.n_faces() + sides);
  net_->first_midpoint = static_cast<std::uint32_t>(mesh.n_vertices());
  net_->cuts.clear();
}

//         apex                         apex
//        /    \                       /  | \                                                                          .
//   before     after      ->     before  |   after        A halfedge's corner is the one at its end.
//     /          \                  /    | \                                                                       .
//  start --------> end          start --mid---> end
std::array<std::uint32_t, 2> OpenMeshBridge::cut(std::uint32_t edge, float at, std::uint32_t position_class,
                                                 const glm::vec3& position,
                                                 const std::array<std::uint32_t, 2>& vertex_of_side) {
  Net& net = *net_;
  struct Half {
    HalfedgeHandle after, before;
    Net::Corner start, middle, end;
    std::uint32_t triangle = kNothing;
  };
  std::array<Half, 2> halves;

  // What the triangles on both sides look like before the cut.
  for (unsigned int which = 0; which < 2; ++which) {
    const HalfedgeHandle halfedge = net.mesh.halfedge_handle(edge_of(edge), which);
    if (net.mesh.is_boundary(halfedge)) {
      continue;
    }
    Half& half = halves[which];
    half.after = net.mesh.next_halfedge_handle(halfedge);
    half.before = net.mesh.prev_halfedge_handle(halfedge);
    half.start = net.mesh.property(net.corner, half.before);
    half.end = net.mesh.property(net.corner, halfedge);
    const bool forwards =
        net.mesh.property(net.position_class, net.mesh.to_vertex_handle(halfedge)) == end_classes(edge).y;
    half.middle = {vertex_of_side[which], glm::mix(half.start.at, half.end.at, forwards ? at : 1.0F - at)};
    half.triangle = net.mesh.property(net.triangle, net.mesh.face_handle(halfedge));
  }

  std::array<std::uint32_t, 2> added{kNothing, kNothing};
  net.mesh.split(edge_of(edge), net.add_vertex(position_class, point_of(position)));

  // `after` and `before` keep their corners; each now has a triangle of its own with two new halfedges.
  for (std::size_t which = 0; which < 2; ++which) {
    const Half& half = halves[which];
    if (!half.after.is_valid()) {
      continue;
    }
    // OpenMesh numbers new faces behind all others.
    added[which] = std::max(number_of(net.mesh.face_handle(half.after)), number_of(net.mesh.face_handle(half.before)));
    const HalfedgeHandle from_apex = net.mesh.next_halfedge_handle(half.after);
    const HalfedgeHandle from_start = net.mesh.next_halfedge_handle(half.before);
    net.mesh.property(net.corner, from_apex) = half.middle;
    net.mesh.property(net.corner, net.mesh.next_halfedge_handle(from_apex)) = half.end;
    net.mesh.property(net.corner, from_start) = half.middle;
    net.mesh.property(net.corner, net.mesh.next_halfedge_handle(from_start)) =
        net.mesh.property(net.corner, half.after);
    net.mesh.property(net.triangle, net.mesh.face_handle(half.after)) = half.triangle;
    net.mesh.property(net.triangle, net.mesh.face_handle(half.before)) = half.triangle;
    if (!net.is_midpoint(net.mesh.to_vertex_handle(half.after))) {
      net.cuts.push_back(net.mesh.edge_handle(from_apex));
    }
  }
  return added;
}

void OpenMeshBridge::end_round() {
  for (const EdgeHandle cut : net_->cuts) {
    if (net_->should_turn(cut)) {
      net_->turn(cut);  // if it cannot be, the other diagonal cuts the triangle without a gap as well
    }
  }
}

void OpenMeshBridge::write_elements(RefinedMesh& mesh) const {
  const Net& net = *net_;
  const std::size_t element_count = net.mesh.n_faces();
  mesh.elements.resize(element_count);
  mesh.triangle_of_element.resize(element_count);
  mesh.part_of_element.resize(element_count);
  for (const FaceHandle face : net.mesh.faces()) {
    const std::uint32_t element = number_of(face);
    mesh.triangle_of_element[element] = net.mesh.property(net.triangle, face);
    HalfedgeHandle halfedge = net.mesh.halfedge_handle(face);
    for (int i = 0; i < 3; ++i) {
      const Net::Corner& corner = net.mesh.property(net.corner, halfedge);
      mesh.elements[element][i] = corner.vertex;
      mesh.part_of_element[element].corner[i] = corner.at;
      halfedge = net.mesh.next_halfedge_handle(halfedge);
    }
  }
}

}  // namespace radiosity
