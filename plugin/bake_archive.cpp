#include "plugin/bake_archive.h"

#include <algorithm>
#include <utility>

namespace gltf_radiosity {
namespace {

using radiosity::RefinedMesh;

/// Reads an array of the mesh; remembers what went wrong first.
class MeshReader {
 public:
  explicit MeshReader(const Archive& archive) : archive_(archive) {}

  template <typename T>
  void read(std::string_view name, std::vector<T>& values) {
    if (failure) return;
    Result<std::vector<T>> stored = archive_.read_vector<T>(name);
    if (!stored) {
      failure = stored.error();
    } else {
      values = std::move(*stored);
    }
  }

  std::optional<Error> failure;

 private:
  const Archive& archive_;
};

/// Which array of the mesh cannot be, or null.
const char* impossible_part(const RefinedMesh& mesh, std::size_t triangle_count) {
  const std::size_t vertices = mesh.positions.size(), elements = mesh.elements.size();
  if (mesh.normals.size() != vertices) return "normals";
  if (mesh.scene_vertex_count > vertices || mesh.cuts.size() != vertices - mesh.scene_vertex_count) return "cuts";
  for (std::size_t k = 0; k < mesh.cuts.size(); ++k) {
    const glm::uvec2 ends = mesh.cuts[k].ends;
    if (std::max(ends.x, ends.y) >= mesh.scene_vertex_count + k) return "cuts";
  }
  const auto is_outside = [&](const glm::uvec3& e) { return std::max({e.x, e.y, e.z}) >= vertices; };
  if (std::any_of(mesh.elements.begin(), mesh.elements.end(), is_outside)) return "elements";
  const auto& triangles = mesh.triangle_of_element;
  if (triangles.size() != elements || !std::is_sorted(triangles.begin(), triangles.end())) return "triangles";
  if (!triangles.empty() && triangles.back() >= triangle_count) return "triangles";
  return mesh.part_of_element.size() != elements ? "parts" : nullptr;
}

}  // namespace

void add_bake(ArchiveWriter& archive, const radiosity::Bake& bake) {
  const RefinedMesh& mesh = bake.mesh;
  archive.add_value("scene vertices", mesh.scene_vertex_count);
  archive.add("cuts", mesh.cuts, Packing::kZstd);
  archive.add("positions", mesh.positions, Packing::kZstd);
  archive.add("normals", mesh.normals, Packing::kZstd);
  archive.add("elements", mesh.elements, Packing::kZstd);
  archive.add("triangles", mesh.triangle_of_element, Packing::kZstd);
  archive.add("parts", mesh.part_of_element, Packing::kZstd);
  archive.add("irradiance", bake.irradiance, Packing::kZstd);
  archive.add_value("report", bake.report);
}

Result<radiosity::Bake> read_bake(const Archive& archive, std::size_t scene_vertex_count,
                                  std::size_t scene_triangle_count) {
  // What is stored.
  radiosity::Bake bake;
  RefinedMesh& mesh = bake.mesh;
  MeshReader reader(archive);
  reader.read("cuts", mesh.cuts);
  reader.read("positions", mesh.positions);
  reader.read("normals", mesh.normals);
  reader.read("elements", mesh.elements);
  reader.read("triangles", mesh.triangle_of_element);
  reader.read("parts", mesh.part_of_element);
  reader.read("irradiance", bake.irradiance);
  if (reader.failure) return *reader.failure;
  const Result<std::uint32_t> scene_vertices = archive.read_value<std::uint32_t>("scene vertices");
  if (!scene_vertices) return scene_vertices.error();
  const auto report = archive.read_value<radiosity::BakeReport>("report");
  if (!report) return report.error();
  mesh.scene_vertex_count = *scene_vertices;
  bake.report = *report;

  // Whether that fits the scene and together.
  if (mesh.scene_vertex_count != scene_vertex_count) return archive.damaged("scene vertices", "another scene");
  if (const char* const part = impossible_part(mesh, scene_triangle_count)) {
    return archive.damaged(part, "does not fit the others");
  }
  if (bake.irradiance.size() != mesh.positions.size()) return archive.damaged("irradiance", "has another size");
  return bake;
}

}  // namespace gltf_radiosity
