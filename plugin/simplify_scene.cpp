#include "plugin/simplify_scene.h"

#include <cmath>
#include <set>
#include <utility>

#include "core/mesh/simplify.h"

namespace gltf_radiosity {
namespace {

/// Leaves in an instance only the elements [first, last) of those that stay.
void shrink(const radiosity::Simplified& simplified, std::size_t first, std::size_t last, bool mirrored,
            const std::vector<std::uint32_t>& output_of, RefinedPrimitive& refined) {
  // The vertices that are still used.
  constexpr std::uint32_t kUnused = radiosity::kNothing;
  std::vector<std::uint32_t> written(refined.vertices.size(), kUnused);
  for (std::size_t e = first; e < last; ++e) {
    for (int k = 0; k < 3; ++k) written[output_of[simplified.corners[e][k]]] = 0;
  }
  std::vector<std::uint32_t> kept;
  for (std::uint32_t v = 0; v < written.size(); ++v) {
    if (written[v] == kUnused) continue;
    written[v] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(v);
  }
  if (kept.size() == refined.vertices.size()) return;

  // Triangles between them.
  refined.kept = std::move(kept);
  refined.changed = true;
  refined.triangles.clear();
  refined.elements.assign(simplified.elements.begin() + static_cast<std::ptrdiff_t>(first),
                          simplified.elements.begin() + static_cast<std::ptrdiff_t>(last));
  for (std::size_t e = first; e < last; ++e) {
    const glm::uvec3& corners = simplified.corners[e];
    const glm::uvec3 triangle(written[output_of[corners.x]], written[output_of[corners.y]],
                              written[output_of[corners.z]]);
    refined.triangles.push_back(mirrored ? glm::uvec3(triangle.x, triangle.z, triangle.y) : triangle);
  }
}

}  // namespace

SimplifyReport simplify_scene(const Document& document, const ImportedScene& scene, const radiosity::Bake& bake,
                              const ExposedColors& colors, const Options& options,
                              std::vector<RefinedPrimitive>& refined, const radiosity::Progress& progress) {
  progress.update("simplify", 0.0);
  const radiosity::RefinedMesh& mesh = bake.mesh;
  const radiosity::Simplified simplified =
      radiosity::simplify(mesh, carried_attributes(document, scene, mesh, refined, colors, options), progress);

  // Elements come in the order of the instances.
  SimplifyReport report;
  std::vector<std::uint32_t> output_of(mesh.positions.size());
  std::size_t element = 0;
  for (std::size_t i = 0; i < refined.size(); ++i) {
    for (std::uint32_t v = 0; v < refined[i].vertices.size(); ++v) output_of[refined[i].vertices[v]] = v;
    const std::size_t first = element;
    const std::uint32_t end = scene.instances[i].first_triangle + scene.instances[i].triangle_count;
    while (element < simplified.elements.size() && mesh.triangle_of_element[simplified.elements[element]] < end) {
      ++element;
    }
    if (!may_lose_vertices(document, scene.instances[i])) continue;
    shrink(simplified, first, element, scene.instances[i].mirrored, output_of, refined[i]);
    report.removed_vertices += refined[i].vertices.size() - refined[i].written_vertex_count();
  }
  const MeanColor mean = mean_color(colors);
  if (mean.luminance > 0.0) {
    report.light_change = std::sqrt(simplified.squared_light_change / mean.area) / mean.luminance;
  }
  return report;
}

void warn_of_named_vertices(const Document& document, const ImportedScene& scene, std::vector<Warning>& warnings) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> warned;
  for (const PrimitiveInstance& instance : scene.instances) {
    if (!instance.receives || may_lose_vertices(document, instance)) continue;
    if (!warned.emplace(instance.mesh, instance.primitive).second) continue;
    warnings.push_back({"not-simplified", place_of_primitive(instance.mesh, instance.primitive),
                        "is not simplified: an extension may name its vertices by their numbers"});
  }
}

}  // namespace gltf_radiosity
