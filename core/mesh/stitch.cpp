#include "core/mesh/stitch.h"

#include <array>
#include <unordered_map>
#include <vector>

#include "core/mesh/t_vertices.h"

namespace radiosity {
namespace {

/// Files hold coordinates rounded to fewer digits than floats have: this much more may a vertex be off an edge.
constexpr float kToleranceOverRounding = 10.0F;

/// Cuts one open edge at `share` from its end of class `from`; returns the number of the part behind the cut.
std::uint32_t cut_open_edge(CutMesh& cut, std::uint32_t edge, std::uint32_t from, float share, std::uint32_t at_class) {
  // The new vertex, between the two that the only triangle names.
  OpenMeshBridge& bridge = cut.bridge;
  const unsigned int side = bridge.triangle_at(edge, 0) != kNothing ? 0 : 1;
  const glm::uvec2 classes = bridge.end_classes(edge), ends = bridge.vertices_at(edge, side);
  const bool starts_at_from = cut.mesh.positions[ends.x] == cut.welder.positions()[from];
  std::array<std::uint32_t, 2> vertex_of_side{kNothing, kNothing};
  vertex_of_side[side] = cut.add_cut({ends, starts_at_from ? share : 1.0F - share}, at_class);

  // The cut, and which part is which.
  const std::uint32_t edge_count = bridge.edge_count(), to = classes.x == from ? classes.y : classes.x;
  bridge.cut(edge, classes.x == from ? share : 1.0F - share, at_class, cut.welder.positions()[at_class],
             vertex_of_side);
  for (std::uint32_t part = edge_count; part < bridge.edge_count(); ++part) {
    if (pair_key(bridge.end_classes(part)) == pair_key({at_class, to})) return part;
  }
  return edge;
}

}  // namespace

std::size_t stitch(CutMesh& cut, std::size_t max_cuts) {
  const float tolerance = kToleranceOverRounding * rounding_tolerance(cut.mesh.positions);
  const std::vector<TVertex> found = find_t_vertices(cut.mesh.positions, cut.mesh.elements, tolerance);
  if (found.empty() || found.size() > max_cuts) return 0;

  // The edges they lie on.
  std::unordered_map<std::uint64_t, std::uint32_t> edge_between;
  const auto key_of = [&cut](const glm::uvec2& ends) {
    return pair_key({cut.class_of_vertex[ends.x], cut.class_of_vertex[ends.y]});
  };
  for (const TVertex& t : found) edge_between.emplace(key_of(t.edge), kNothing);
  for (std::uint32_t edge = 0; edge < cut.bridge.edge_count(); ++edge) {
    const auto wanted = edge_between.find(pair_key(cut.bridge.end_classes(edge)));
    if (wanted != edge_between.end()) wanted->second = edge;
  }

  // From one end of each edge to the other.
  cut.bridge.begin_round(found.size(), found.size());
  std::uint32_t rest = kNothing, from = kNothing;
  float done = 0.0F;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const TVertex& t = found[i];
    if (i == 0 || found[i - 1].edge != t.edge) {
      rest = edge_between.at(key_of(t.edge));
      from = cut.class_of_vertex[t.edge.x];
      done = 0.0F;
    }
    const std::uint32_t at_class = cut.class_of_vertex[t.vertex];
    rest = cut_open_edge(cut, rest, from, (t.at - done) / (1.0F - done), at_class);
    from = at_class;
    done = t.at;
  }
  cut.write_elements();
  return found.size();
}

}  // namespace radiosity
