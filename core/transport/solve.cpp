#include "core/transport/solve.h"

#include "core/photometry.h"

namespace radiosity {

std::vector<glm::dvec3> first_radiosity(const SolveProblem& problem) {
  const Patches& patches = problem.patches;
  std::vector<glm::dvec3> first(patches.patch_count());
  for (std::uint32_t i = 0; i < patches.patch_count(); ++i) {
    first[i] = glm::dvec3(exitance_of_luminance(patches.glow[i])) +
               glm::dvec3(patches.reflectance[i]) * glm::dvec3(problem.direct[i]);
  }
  return first;
}

double flux_of(const Patches& patches, std::span<const glm::dvec3> radiosity) {
  double flux = 0.0;
  for (std::uint32_t i = 0; i < patches.patch_count(); ++i) {
    flux += double{patches.area[i]} * double{luminance_of(Rgb(radiosity[i]))};
  }
  return flux;
}

glm::dvec3 mean_reflectance(const Patches& patches) {
  glm::dvec3 sum(0.0);
  double area = 0.0;
  for (std::uint32_t i = 0; i < patches.patch_count(); ++i) {
    sum += double{patches.area[i]} * glm::dvec3(patches.reflectance[i]);
    area += double{patches.area[i]};
  }
  return area > 0.0 ? sum / area : sum;
}

}  // namespace radiosity
