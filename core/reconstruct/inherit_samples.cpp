#include "core/reconstruct/inherit_samples.h"

#include <algorithm>
#include <glm/common.hpp>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace radiosity {
namespace {

/// The weights of the corners of `part` at a place of its triangle: all positive inside. Nothing lies inside a part
/// without area, which is what rounding leaves of one that was cut very close to a corner.
glm::vec3 weights_in(const SubTriangle& part, Barycentrics at) {
  const auto cross = [](const glm::dvec2& u, const glm::dvec2& v) { return u.x * v.y - u.y * v.x; };
  const glm::dvec2 first(part.corner[0]), u = glm::dvec2(part.corner[1]) - first,
                                          v = glm::dvec2(part.corner[2]) - first, w = glm::dvec2(at) - first;
  const double area = cross(u, v);
  if (area == 0.0) return glm::vec3(std::numeric_limits<float>::lowest());
  const double y = cross(w, v) / area, z = cross(u, w) / area;
  return {1.0 - y - z, y, z};
}

/// Places outside by rounding count as on the edge.
glm::vec3 clamped(const glm::vec3& weights) {
  const glm::vec3 inside = glm::max(weights, glm::vec3(0.0F));
  const float sum = inside.x + inside.y + inside.z;
  return sum > 0.0F ? inside / sum : glm::vec3(1.0F / 3.0F);
}

float least(const glm::vec3& weights) { return std::min({weights.x, weights.y, weights.z}); }

/// The parts of each element of before: `first` is the element itself, what is new follows in a list.
class Parts {
 public:
  Parts(std::size_t old_count, std::span<const std::uint32_t> origin_of_element)
      : next_(origin_of_element.size(), kNothing) {
    for (std::size_t e = next_.size(); e-- > old_count;) {
      next_[e] = std::exchange(next_[origin_of_element[e]], static_cast<std::uint32_t>(e));
    }
  }

  /// The part that a place is deepest in.
  std::uint32_t holder(std::uint32_t first, Barycentrics at, const RefinedMesh& mesh) const {
    std::uint32_t best = first;
    if (next_[first] == kNothing) return best;
    float depth = least(weights_in(mesh.part_of_element[first], at));
    for (std::uint32_t e = next_[first]; e != kNothing; e = next_[e]) {
      const float here = least(weights_in(mesh.part_of_element[e], at));
      if (here > depth) depth = here, best = e;
    }
    return best;
  }

  bool is_cut(std::uint32_t first) const { return next_[first] != kNothing; }

 private:
  std::vector<std::uint32_t> next_;  ///< [element_count]
};

}  // namespace

Samples inherit_samples(const Samples& samples, const RefinedMesh& mesh,
                        std::span<const std::uint32_t> origin_of_element) {
  // Where each sample lies now.
  const std::size_t old_count = samples.buried.size(), count = mesh.elements.size();
  const Parts parts(old_count, origin_of_element);
  std::vector<std::uint32_t> holder(samples.sample_count());
  Samples now;
  now.taken = samples.taken;
  now.first_of_element.assign(count + 1, 0);
  for (std::uint32_t e = 0; e < old_count; ++e) {
    for (std::uint32_t s = samples.first_of_element[e]; s < samples.first_of_element[e + 1]; ++s) {
      holder[s] = parts.holder(e, samples.at[s], mesh);
      ++now.first_of_element[holder[s] + std::size_t{1}];
    }
  }
  std::partial_sum(now.first_of_element.begin(), now.first_of_element.end(), now.first_of_element.begin());

  // Sorted by that.
  std::vector<std::uint32_t> next = now.first_of_element;
  now.at.resize(holder.size());
  now.number.resize(holder.size());
  now.weights.resize(holder.size());
  now.irradiance.resize(holder.size());
  for (std::uint32_t e = 0; e < old_count; ++e) {
    for (std::uint32_t s = samples.first_of_element[e]; s < samples.first_of_element[e + 1]; ++s) {
      const std::uint32_t to = next[holder[s]]++;
      now.at[to] = samples.at[s];
      now.number[to] = samples.number[s];
      now.weights[to] =
          parts.is_cut(e) ? clamped(weights_in(mesh.part_of_element[holder[s]], samples.at[s])) : samples.weights[s];
      now.irradiance[to] = samples.irradiance[s];
    }
  }

  // What was buried as a whole is so in all its parts.
  now.buried.resize(count);
  for (std::size_t e = 0; e < count; ++e) {
    const bool none = now.first_of_element[e] == now.first_of_element[e + 1];
    now.buried[e] = none ? samples.buried[origin_of_element[e]] : 0;
  }
  return now;
}

}  // namespace radiosity
