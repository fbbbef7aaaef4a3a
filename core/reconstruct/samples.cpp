#include "core/reconstruct/samples.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

#include "core/parallel.h"
#include "core/reconstruct/inherit_samples.h"

namespace radiosity {
namespace {

/// In an element much larger than others.
constexpr double kMaxSamplesPerElement = 64.0;

/// The shading normal at a place of an element. Corners without a normal, or whose normal points to the other side,
/// count as flat.
glm::vec3 shading_normal(const RefinedMesh& mesh, const glm::uvec3& element, const glm::vec3& weights,
                         const glm::vec3& flat) {
  glm::vec3 sum(0.0F);
  for (int k = 0; k < 3; ++k) {
    const glm::vec3& normal = mesh.normals[element[k]];
    sum += weights[k] * (glm::dot(normal, flat) > 0.0F ? normal : flat);
  }
  return glm::normalize(sum);
}

/// Where the samples of each element start, [element_count + 1]. An element's share is rounded at its place in the
/// running sum, so that many small elements get as many together as one large one.
std::vector<std::uint32_t> allot(const RefinedMesh& mesh, const SampleOptions& options) {
  const std::size_t count = mesh.elements.size();
  std::vector<float> areas(count);
  for (std::uint32_t e = 0; e < count; ++e) areas[e] = element_area(mesh, e);
  const double total_area = std::accumulate(areas.begin(), areas.end(), 0.0);
  const double mean = total_area / static_cast<double>(std::min(count, options.max_ordinary));
  const double share_of_one = total_area / static_cast<double>(options.at_least);

  std::vector<std::uint32_t> first(count + 1, 0);
  const bool every_element = count <= options.max_ordinary;
  double due = 0.5;
  for (std::size_t e = 0; e < count; ++e) {
    double wanted = areas[e] > 0.0F
                        ? std::max(options.per_element * double{areas[e]} / mean, double{areas[e]} / share_of_one)
                        : 0.0;
    if (every_element && areas[e] > 0.0F) wanted = std::max(wanted, 1.0);
    wanted = std::min(wanted, kMaxSamplesPerElement);
    due += wanted;
    const auto here = static_cast<std::uint32_t>(due);
    due -= here;
    first[e + 1] = first[e] + here;
  }
  return first;
}

/// Adds samples to what is `known` of each element: those numbered first[e] to first[e + 1], counted from known.taken.
Samples gather_beside(const Samples& known, const RefinedMesh& mesh, const std::vector<std::uint32_t>& first,
                      const Gatherer& gatherer, const Progress& progress) {
  // Everywhere.
  const std::size_t count = mesh.elements.size(), sample_count = first.back();
  std::vector<Rgb> irradiance(sample_count);
  std::vector<std::uint8_t> buried(sample_count, 0);
  SampleLog* const log = gatherer.log;
  if (log != nullptr) log->grow(known.taken + sample_count);
  parallel_in_chunks(count, 1024, progress, "gather", [&](std::size_t e) {
    for (std::uint32_t s = first[e]; s < first[e + 1]; ++s) {
      const std::uint32_t number = known.taken + s;
      const auto element = static_cast<std::uint32_t>(e);
      const Seen seen = log != nullptr ? log->seen_by(number) : Seen{};
      const Gathered gathered =
          gather_sample(mesh, gatherer, element, number, corner_weights(number), log != nullptr ? &seen : nullptr);
      irradiance[s] = gathered.irradiance;
      buried[s] = gathered.back_share > kBuriedShare ? 1 : 0;
    }
  });

  // Without the buried, behind those that are known.
  Samples samples;
  samples.taken = known.taken + static_cast<std::uint32_t>(sample_count);
  samples.first_of_element.assign(count + 1, 0);
  samples.buried.assign(count, 0);
  const auto add = [&samples](std::uint32_t number, Barycentrics at, const glm::vec3& weights, const Rgb& light) {
    samples.number.push_back(number);
    samples.at.push_back(at);
    samples.weights.push_back(weights);
    samples.irradiance.push_back(light);
  };
  for (std::size_t e = 0; e < count; ++e) {
    for (std::uint32_t s = known.first_of_element[e]; s < known.first_of_element[e + 1]; ++s) {
      add(known.number[s], known.at[s], known.weights[s], known.irradiance[s]);
    }
    for (std::uint32_t s = first[e]; s < first[e + 1]; ++s) {
      if (buried[s] != 0) continue;
      const std::uint32_t number = known.taken + s;
      const glm::vec3 weights = corner_weights(number);
      const auto& corner = mesh.part_of_element[e].corner;
      add(number, weights.x * corner[0] + weights.y * corner[1] + weights.z * corner[2], weights, irradiance[s]);
    }
    samples.first_of_element[e + 1] = static_cast<std::uint32_t>(samples.irradiance.size());
    const bool none = samples.first_of_element[e + 1] == samples.first_of_element[e];
    samples.buried[e] = none && (first[e + 1] > first[e] || known.buried[e] != 0) ? 1 : 0;
  }
  return samples;
}

/// How many samples an element lacks that was cut, as running sums.
std::vector<std::uint32_t> missing(const Samples& known, const RefinedMesh& mesh,
                                   std::span<const std::uint32_t> origin_of_element, int per_element) {
  std::vector<std::uint8_t> is_cut(mesh.elements.size(), 0);
  for (std::uint32_t e = 0; e < is_cut.size(); ++e) {
    if (origin_of_element[e] != e) is_cut[e] = is_cut[origin_of_element[e]] = 1;
  }
  std::vector<std::uint32_t> first(is_cut.size() + 1, 0);
  for (std::uint32_t e = 0; e < is_cut.size(); ++e) {
    const auto here = static_cast<int>(known.first_of_element[e + 1] - known.first_of_element[e]);
    const bool wants = is_cut[e] != 0 && element_area(mesh, e) > 0.0F;
    first[e + 1] = first[e] + static_cast<std::uint32_t>(wants ? std::max(0, per_element - here) : 0);
  }
  return first;
}

}  // namespace

// R2 (Roberts 2018), folded into a triangle. Kept a little away from the edges, where walls meet.
glm::vec3 corner_weights(std::uint32_t number) {
  constexpr std::uint32_t kStepX = 3242174889U, kStepY = 2447445414U;  // in units of 2^-32
  glm::vec2 at(static_cast<float>((number * kStepX) >> 8U) * 0x1p-24F,
               static_cast<float>((number * kStepY) >> 8U) * 0x1p-24F);
  if (at.x + at.y > 1.0F) at = 1.0F - at;
  at = glm::mix(glm::vec2(1.0F / 3.0F), at, 0.94F);
  return {1.0F - at.x - at.y, at.x, at.y};
}

Gathered gather_sample(const RefinedMesh& mesh, const Gatherer& gatherer, std::uint32_t e, std::uint32_t number,
                       const glm::vec3& weights, const Seen* seen) {
  const glm::uvec3& element = mesh.elements[e];
  const glm::vec3 a = mesh.positions[element.x], b = mesh.positions[element.y], c = mesh.positions[element.z];
  const glm::vec3 flat = glm::normalize(glm::cross(b - a, c - a));
  SurfacePoint point{weights.x * a + weights.y * b + weights.z * c, shading_normal(mesh, element, weights, flat)};
  const auto& part = mesh.part_of_element[e].corner;
  const Barycentrics at = weights.x * part[0] + weights.y * part[1] + weights.z * part[2];
  const std::uint32_t triangle = mesh.triangle_of_element[e];
  const bool back_shows = gatherer.shows_reached_side && gatherer.only_back_is_reached(triangle, at);
  if (!back_shows) {
    const Gathered gathered = gatherer.on_front(triangle, at, point, number, seen);
    const bool two_sided = gatherer.scene.surfaces[gatherer.scene.surface_of_triangle[triangle]].two_sided;
    if (gathered.back_share <= kBuriedShare || !two_sided) return gathered;
  }
  point.normal = -point.normal;
  return gatherer.at(point, number, seen);
}

Samples gather_samples(const RefinedMesh& mesh, const Gatherer& gatherer, const SampleOptions& options,
                       const Progress& progress) {
  const std::size_t count = mesh.elements.size();
  Samples none;
  none.first_of_element.assign(count + 1, 0);
  none.buried.assign(count, 0);
  return gather_beside(none, mesh, allot(mesh, options), gatherer, progress);
}

double seconds_to_gather(const RefinedMesh& mesh, const Gatherer& gatherer, const SampleOptions& options,
                         const Progress& progress) {
  if (!progress.seconds_left) return 0.0;
  const std::vector<std::uint32_t> first = allot(mesh, options);
  const std::size_t count = mesh.elements.size();
  constexpr std::size_t kTried = 128;
  const std::size_t stride = count / kTried + 1;
  const double before = progress.seconds_left();
  std::vector<std::uint32_t> tried(count / stride + 1, 0);
  parallel_in_chunks(tried.size(), kTried, {nullptr, progress.cancelled}, "gather", [&](std::size_t k) {
    const auto e = static_cast<std::uint32_t>(std::min(k * stride, count - 1));
    if (first[e] == first[e + 1]) return;
    gather_sample(mesh, gatherer, e, first[e], corner_weights(first[e]));
    tried[k] = 1;
  });
  const auto tried_count = std::max(1U, std::accumulate(tried.begin(), tried.end(), 0U));
  const double left = progress.seconds_left();
  const double seconds = (before - left) * static_cast<double>(first.back()) / tried_count;
  if (seconds > left) throw OutOfTime{};
  return seconds;
}

Samples samples_after_cuts(const Samples& samples, const RefinedMesh& mesh,
                           std::span<const std::uint32_t> origin_of_element, const Gatherer& gatherer,
                           const SampleOptions& options, const Progress& progress) {
  const Samples known = inherit_samples(samples, mesh, origin_of_element);
  return gather_beside(known, mesh, missing(known, mesh, origin_of_element, options.per_element), gatherer, progress);
}

ElementLight mean_of_samples(const Samples& samples) { return mean_of_samples(samples, samples.irradiance); }

ElementLight mean_of_samples(const Samples& samples, std::span<const Rgb> irradiance) {
  const std::size_t count = samples.first_of_element.size() - 1;
  ElementLight light{std::vector<Rgb>(count, Rgb(0.0F)), std::vector<std::uint8_t>(count, 1)};
  for (std::size_t e = 0; e < count; ++e) {
    const std::uint32_t first = samples.first_of_element[e], last = samples.first_of_element[e + 1];
    if (first == last) continue;
    for (std::uint32_t s = first; s < last; ++s) light.irradiance[e] += irradiance[s];
    light.irradiance[e] /= static_cast<float>(last - first);
    light.unknown[e] = 0;
  }
  return light;
}

}  // namespace radiosity
