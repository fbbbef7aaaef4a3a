#include "core/reconstruct/shown_light.h"

#include "core/parallel.h"
#include "core/photometry.h"
#include "core/reconstruct/exposure.h"

namespace radiosity {

Rgb ShownLight::under(std::uint32_t element, const Rgb& irradiance) const {
  return reflected_luminance(reflectance[element], irradiance) + emission[element];
}

ShownLight shown_light(const Scene& scene, const RefinedMesh& mesh) {
  const std::size_t count = mesh.elements.size();
  ShownLight shown{std::vector<Rgb>(count), std::vector<Rgb>(count)};
  parallel_in_chunks(count, count, {}, "", [&](std::size_t e) {
    const std::uint32_t triangle = mesh.triangle_of_element[e];
    shown.reflectance[e] = mean_reflectance(scene, triangle, mesh.part_of_element[e]);
    shown.emission[e] = shown_emission(scene, triangle, mesh.part_of_element[e]);
  });
  return shown;
}

float exposure_of(const RefinedMesh& mesh, const Samples& samples, const ShownLight& shown) {
  const ElementLight light = mean_of_samples(samples);
  std::vector<ExposureSample> exposed(mesh.elements.size());
  for (std::uint32_t e = 0; e < exposed.size(); ++e) {
    if (light.unknown[e] != 0) continue;
    exposed[e] = {shown.under(e, light.irradiance[e]), element_area(mesh, e), shown.emission[e] != Rgb(0.0F)};
  }
  return automatic_exposure(exposed);
}

}  // namespace radiosity
