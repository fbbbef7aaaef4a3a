// Where light is gathered: places inside the elements, spread by area.
//
// Not at the vertices: a vertex touches walls and floors, and sees neither side of what it touches.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/refined_mesh.h"
#include "core/progress.h"
#include "core/reconstruct/gather.h"

namespace radiosity {

struct SampleOptions {
  int per_element = 3;           ///< in an element of ordinary size, >= 1
  std::size_t at_least = 6'000;  ///< samples in all, >= 1: meshes of few elements get more in each
  std::size_t max_ordinary =
      300'000;  ///< elements of ordinary size at most: in finer meshes samples are spread by area
};

/// Samples, grouped by element in ascending order; none of them buried. Shapes: per sample [sample_count()].
struct Samples {
  std::vector<std::uint32_t> first_of_element;  ///< [element_count + 1]
  std::vector<glm::vec3> weights;               ///< of the element's corners, summing to 1
  std::vector<Rgb> irradiance;                  ///< H, lx
  std::vector<std::uint8_t> buried;             ///< [element_count]: 1 where samples were taken and all were buried

  std::size_t sample_count() const { return irradiance.size(); }
};

/// Gathers at samples inside each element: `per_element`, more where it is larger than others, fewer where a mesh is
/// finer than its light. A surface that is lit on both sides shows its front; its back where the front is buried.
/// Parallel; throws `Cancelled`.
Samples gather_samples(const RefinedMesh& mesh, const Gatherer& gatherer, const SampleOptions& options,
                       const Progress& progress);

/// Light per element, [element_count].
struct ElementLight {
  std::vector<Rgb> irradiance;        ///< mean H over the samples, lx
  std::vector<std::uint8_t> unknown;  ///< 1 where there is no sample
};
ElementLight mean_of_samples(const Samples& samples);

}  // namespace radiosity
