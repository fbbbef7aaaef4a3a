// Where light is gathered: places inside the elements, spread by area.
//
// Not at the vertices: a vertex touches walls and floors, and sees neither side of what it touches.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/refined_mesh.h"
#include "core/progress.h"
#include "core/reconstruct/gather.h"

namespace radiosity {

struct SampleOptions {
  int per_element = 3;           ///< in an element of ordinary size, >= 1; in a smaller one fewer, but one
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
  std::vector<Barycentrics> at{};               ///< in the element's triangle; [sample_count()]
  std::vector<std::uint32_t> number{};          ///< of each sample, among those taken
  std::uint32_t taken = 0;                      ///< samples so far, buried ones included

  std::size_t sample_count() const { return irradiance.size(); }
};

/// The weights of an element's corners at the place of sample `number`, in a sequence that runs on from element to
/// element.
glm::vec3 corner_weights(std::uint32_t number);

/// What is seen from the place of element `e` where its corners have these weights, on the side that shows; buried if
/// that side is. `number` picks the place in the low-discrepancy sequences. `seen` is set, if given.
Gathered gather_sample(const RefinedMesh& mesh, const Gatherer& gatherer, std::uint32_t e, std::uint32_t number,
                       const glm::vec3& weights, const Seen* seen = nullptr);

/// Gathers at samples inside each element: `per_element`, more where it is larger than others, fewer where it is
/// smaller or a mesh is finer than its light. What each has seen goes into the gatherer's log, if it has one. A surface
/// that is lit on both sides shows its front; its back where the front is buried. Parallel; throws `Cancelled`.
Samples gather_samples(const RefinedMesh& mesh, const Gatherer& gatherer, const SampleOptions& options,
                       const Progress& progress);

/// How long gather_samples() will take, judged by a few samples; 0 where nobody asks for the time. Throws `OutOfTime`
/// if fewer seconds are left.
double seconds_to_gather(const RefinedMesh& mesh, const Gatherer& gatherer, const SampleOptions& options,
                         const Progress& progress);

/// After the mesh was cut further: `samples` pass to the elements that they now lie in, and elements that were cut and
/// hold fewer than `per_element` get more. `origin_of_element` [element_count] says which element of before each one
/// was part of. Parallel; throws `Cancelled`.
Samples samples_after_cuts(const Samples& samples, const RefinedMesh& mesh,
                           std::span<const std::uint32_t> origin_of_element, const Gatherer& gatherer,
                           const SampleOptions& options, const Progress& progress);

/// Light per element, [element_count].
struct ElementLight {
  std::vector<Rgb> irradiance;        ///< mean H over the samples, lx
  std::vector<std::uint8_t> unknown;  ///< 1 where there is no sample
};
ElementLight mean_of_samples(const Samples& samples);
/// The same for other light of the samples, [sample_count].
ElementLight mean_of_samples(const Samples& samples, std::span<const Rgb> irradiance);

}  // namespace radiosity
