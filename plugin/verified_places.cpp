#include "plugin/verified_places.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace gltf_radiosity {
namespace {

using radiosity::Rgb;
using radiosity::SurfacePlace;

/// COLOR_0 times the factor that ends at white, give or take the rounding of 16 bits.
constexpr float kClippedFrom = 0.9999F;

const PrimitiveInstance& instance_of(const ImportedScene& scene, std::uint32_t triangle) {
  const auto after =
      std::upper_bound(scene.instances.begin(), scene.instances.end(), triangle,
                       [](std::uint32_t t, const PrimitiveInstance& instance) { return t < instance.first_triangle; });
  return *(after - 1);
}

}  // namespace

std::vector<std::uint8_t> baked_triangles(const ImportedScene& output) {
  std::vector<std::uint8_t> baked(output.scene.triangles.size(), 0);
  for (const PrimitiveInstance& instance : output.instances) {
    const std::uint32_t surface = output.scene.surface_of_triangle[instance.first_triangle];
    if (!output.materials[instance.material].unlit || output.detail->surface_has_colors[surface] == 0) continue;
    std::fill_n(baked.begin() + instance.first_triangle, instance.triangle_count, std::uint8_t{1});
  }
  return baked;
}

bool is_clipped(const ImportedScene& output, const SurfacePlace& place) {
  const ImportedMaterial& material = output.materials[instance_of(output, place.triangle).material];
  const glm::vec4 color = material.base_color_factor * output.detail->vertex_color(place.triangle, place.at);
  return std::max({color.x, color.y, color.z}) >= kClippedFrom;
}

Rgb displayed_reflectance(const ImportedScene& input, const SurfacePlace& place) {
  return input.detail->shown_reflectance(place.triangle, {{place.at, place.at, place.at}});
}

SourceFinder::SourceFinder(const ImportedScene& input, const radiosity::RayScene& rays, const ImportedScene& output)
    : input_(input), output_(output), finder_(rays) {}

std::optional<radiosity::ReferencePlace> SourceFinder::find(const SurfacePlace& place) const {
  // Where surfaces coincide, those of the same node and primitive belong together: a bake keeps both numbers.
  const PrimitiveInstance& baked = instance_of(output_, place.triangle);
  const auto preference = [&](std::uint32_t triangle) {
    const PrimitiveInstance& source = instance_of(input_, triangle);
    if (!source.receives) return -1;
    return (source.node == baked.node ? 2 : 0) + (source.primitive == baked.primitive ? 1 : 0);
  };
  const glm::vec3 position = radiosity::point_at(output_.scene, place.triangle, place.at);
  const glm::vec3 normal = glm::normalize(radiosity::scaled_normal(output_.scene, place.triangle));
  const std::optional<SurfacePlace> found = finder_.find(position, normal, preference);
  if (!found) return std::nullopt;

  const radiosity::Scene& scene = input_.scene;
  return radiosity::ReferencePlace{
      radiosity::point_at(scene, found->triangle, found->at), radiosity::shading_normal(scene, *found),
      displayed_reflectance(input_, *found),
      radiosity::mean_emission(scene, found->triangle, {{found->at, found->at, found->at}})};
}

VerifiedPlaces verified_places(const SourceFinder& finder, const ImportedScene& output, const VerifyOptions& options) {
  VerifiedPlaces result;
  for (const SurfacePlace& place :
       radiosity::random_places(output.scene, baked_triangles(output), options.points, options.seed)) {
    const std::optional<radiosity::ReferencePlace> source = finder.find(place);
    if (!source) {
      ++result.unmatched;
      continue;
    }
    result.places.push_back(*source);
    result.displayed.push_back(output.detail->unlit_color(place.triangle, place.at));
    result.clipped.push_back(is_clipped(output, place) ? 1 : 0);
  }
  return result;
}

}  // namespace gltf_radiosity
