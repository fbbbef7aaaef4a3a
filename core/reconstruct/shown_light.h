// What a camera sees of elements under given light: rho H / pi + Le.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/refined_mesh.h"
#include "core/reconstruct/samples.h"
#include "core/scene.h"

namespace radiosity {

/// What elements are made of, on average. Shapes: [element_count].
struct ShownLight {
  std::vector<Rgb> reflectance;
  std::vector<Rgb> emission;  ///< cd/m2

  /// cd/m2
  Rgb under(std::uint32_t element, const Rgb& irradiance) const;
};

/// Parallel.
ShownLight shown_light(const Scene& scene, const RefinedMesh& mesh);

/// The exposure that automatic_exposure() gives to the samples, m2/cd.
float exposure_of(const RefinedMesh& mesh, const Samples& samples, const ShownLight& shown);

}  // namespace radiosity
