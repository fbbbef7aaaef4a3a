#include "plugin/export_meshes.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <numeric>
#include <string>
#include <utility>

namespace gltf_radiosity {
namespace {

std::string joints(std::size_t n) { return "JOINTS_" + std::to_string(n); }
std::string weights(std::size_t n) { return "WEIGHTS_" + std::to_string(n); }

/// Whether set n is complete and stored as the specification says, so that its pairs can be merged.
bool has_skin_set(const Document& document, const Json& attributes, std::size_t n) {
  if (!attributes.contains(joints(n)) || !attributes.contains(weights(n))) return false;
  const Json& accessors = document.json["accessors"];
  const Json& joint = accessors[attributes[joints(n)].get<std::size_t>()];
  const Json& weight = accessors[attributes[weights(n)].get<std::size_t>()];
  const int type = joint["componentType"].get<int>();
  return joint["type"] == "VEC4" && weight["type"] == "VEC4" && (type == 5121 || type == 5123);
}

RawAccessor source_rows(const Document& document, const PrimitiveInstance& instance, std::size_t accessor) {
  return picked(read_accessor(document, accessor), instance.source_vertex);
}

/// Rewrites the accessors of one primitive.
class AttributeExporter {
 public:
  AttributeExporter(Document& document, BufferBuilder& buffer, const PrimitiveInstance& instance,
                    const RefinedPrimitive& refined)
      : document_(document), buffer_(buffer), instance_(instance), refined_(refined) {}

  /// REQUIRES: not a pair of JOINTS_n and WEIGHTS_n.
  std::size_t attribute(const std::string& semantic, std::size_t accessor, bool morph_target) {
    const AttributeRows rows = attribute_rows(document_, instance_, refined_, semantic, accessor, morph_target);
    const auto [known, is_new] = exported_.try_emplace({accessor, rows.how}, 0);
    if (is_new) known->second = append(rows.raw, accessor, semantic == "POSITION");
    return known->second;
  }

  /// All pairs of JOINTS_n and WEIGHTS_n in `attributes`.
  void skin(Json& attributes) {
    const std::vector<SkinSet> sets = skin_rows(document_, instance_, refined_, attributes);
    for (std::size_t n = 0; n < sets.size(); ++n) {
      attributes[joints(n)] = append(sets[n].joints, attributes[joints(n)].get<std::size_t>(), false);
      attributes[weights(n)] = append(sets[n].weights, attributes[weights(n)].get<std::size_t>(), false);
    }
    skin_set_count_ = sets.size();
  }

  bool is_done(const std::string& semantic) const { return is_of_skin(semantic, skin_set_count_); }

 private:
  std::size_t append(const RawAccessor& raw, std::size_t like, bool bounds) {
    return append_accessor(document_, buffer_, picked(raw, refined_.kept), BufferTarget::kVertices,
                           document_.json["accessors"][like], bounds);
  }

  Document& document_;
  BufferBuilder& buffer_;
  const PrimitiveInstance& instance_;
  const RefinedPrimitive& refined_;
  std::map<std::pair<std::size_t, Interpolation>, std::size_t> exported_;
  std::size_t skin_set_count_ = 0;
};

/// Deals the vertices to the instances; returns the output vertex of each vertex.
std::vector<std::uint32_t> split_vertices(const radiosity::RefinedMesh& mesh, const ImportedScene& scene,
                                          std::vector<RefinedPrimitive>& refined) {
  const std::size_t vertex_count = mesh.scene_vertex_count + mesh.cuts.size();
  std::vector<std::uint32_t> instance_of(vertex_count), output_of(vertex_count);

  // The scene's own.
  for (std::uint32_t i = 0; i < refined.size(); ++i) {
    const PrimitiveInstance& instance = scene.instances[i];
    refined[i].vertices.resize(instance.vertex_count);
    std::iota(refined[i].vertices.begin(), refined[i].vertices.end(), instance.first_vertex);
    for (std::uint32_t v = 0; v < instance.vertex_count; ++v) {
      instance_of[instance.first_vertex + v] = i;
      output_of[instance.first_vertex + v] = v;
    }
  }

  // Cuts go where their ends are.
  for (std::uint32_t k = 0; k < mesh.cuts.size(); ++k) {
    const std::uint32_t vertex = mesh.scene_vertex_count + k;
    const glm::uvec2 ends = mesh.cuts[k].ends;
    assert(ends.x < vertex && ends.y < vertex && instance_of[ends.x] == instance_of[ends.y]);
    instance_of[vertex] = instance_of[ends.x];
    RefinedPrimitive& primitive = refined[instance_of[vertex]];
    output_of[vertex] = static_cast<std::uint32_t>(primitive.vertices.size());
    primitive.vertices.push_back(vertex);
    primitive.cuts.push_back({{output_of[ends.x], output_of[ends.y]}, mesh.cuts[k].at});
  }
  return output_of;
}

}  // namespace

std::vector<RefinedPrimitive> split_by_instance(const radiosity::RefinedMesh& mesh, const ImportedScene& scene) {
  std::vector<RefinedPrimitive> refined(scene.instances.size());
  const std::vector<std::uint32_t> output_of = split_vertices(mesh, scene, refined);

  // Elements come in the order of their triangles, and so of the instances.
  std::uint32_t element = 0;
  for (std::size_t i = 0; i < refined.size(); ++i) {
    const PrimitiveInstance& instance = scene.instances[i];
    const std::uint32_t end = instance.first_triangle + instance.triangle_count;
    for (; element < mesh.elements.size() && mesh.triangle_of_element[element] < end; ++element) {
      const glm::uvec3& corners = mesh.elements[element];
      const glm::uvec3 triangle(output_of[corners.x], output_of[corners.y], output_of[corners.z]);
      refined[i].triangles.push_back(instance.mirrored ? glm::uvec3(triangle.x, triangle.z, triangle.y) : triangle);
      refined[i].elements.push_back(element);
    }
    refined[i].changed = !refined[i].cuts.empty() || refined[i].triangles.size() != instance.triangle_count ||
                         !instance.source_vertex.empty();
  }
  return refined;
}

AttributeRows attribute_rows(const Document& document, const PrimitiveInstance& instance,
                             const RefinedPrimitive& refined, std::string_view semantic, std::size_t accessor,
                             bool morph_target) {
  AttributeRows rows{source_rows(document, instance, accessor)};
  if (!morph_target) rows.how = interpolation_of(semantic, rows.raw);
  append_cuts(rows.raw, rows.how, refined.cuts);
  return rows;
}

std::vector<SkinSet> skin_rows(const Document& document, const PrimitiveInstance& instance,
                               const RefinedPrimitive& refined, const Json& attributes) {
  std::vector<SkinSet> sets;
  for (std::size_t n = 0; has_skin_set(document, attributes, n); ++n) {
    sets.push_back({source_rows(document, instance, attributes[joints(n)].get<std::size_t>()),
                    source_rows(document, instance, attributes[weights(n)].get<std::size_t>())});
  }
  append_cuts(sets, refined.cuts);
  return sets;
}

bool is_of_skin(std::string_view semantic, std::size_t set_count) {
  for (std::size_t n = 0; n < set_count; ++n) {
    if (semantic == joints(n) || semantic == weights(n)) return true;
  }
  return false;
}

void export_geometry(Document& document, BufferBuilder& buffer, const PrimitiveInstance& instance,
                     const RefinedPrimitive& refined, Json& primitive) {
  // Attributes.
  AttributeExporter exporter(document, buffer, instance, refined);
  Json& attributes = primitive["attributes"];
  exporter.skin(attributes);
  for (auto& [semantic, accessor] : attributes.items()) {
    if (semantic == "COLOR_0" || exporter.is_done(semantic)) continue;
    accessor = exporter.attribute(semantic, accessor.get<std::size_t>(), false);
  }

  // Morph targets.
  if (primitive.contains("targets")) {
    for (Json& target : primitive["targets"]) {
      for (auto& [semantic, accessor] : target.items()) {
        accessor = exporter.attribute(semantic, accessor.get<std::size_t>(), true);
      }
    }
  }

  // Triangles.
  const Json like = primitive.contains("indices") ? document.json["accessors"][primitive["indices"].get<std::size_t>()]
                                                  : Json::object();
  const RawAccessor indices = index_rows(refined.triangles, refined.written_vertex_count());
  primitive["indices"] = append_accessor(document, buffer, indices, BufferTarget::kIndices, like);
  if (primitive.contains("mode")) primitive["mode"] = 4;
}

}  // namespace gltf_radiosity
