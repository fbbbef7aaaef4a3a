#include "core/mesh/carried.h"

#include <algorithm>
#include <functional>
#include <unordered_set>

namespace radiosity {

std::vector<std::uint32_t> find_equal_vertices(std::span<const std::uint32_t> class_of_vertex, const Carried& carried) {
  const auto hash = [&](std::uint32_t v) { return std::hash<std::uint64_t>{}(class_of_vertex[v]); };
  const auto equal = [&](std::uint32_t a, std::uint32_t b) {
    if (class_of_vertex[a] != class_of_vertex[b] || carried.label[a] != carried.label[b] ||
        carried.fixed[a] != carried.fixed[b] || carried.light[a] != carried.light[b]) {
      return false;
    }
    return std::ranges::equal(carried.values_of(a), carried.values_of(b));
  };
  std::unordered_set<std::uint32_t, decltype(hash), decltype(equal)> different(class_of_vertex.size(), hash, equal);
  std::vector<std::uint32_t> equal_to(class_of_vertex.size());
  for (std::uint32_t v = 0; v < equal_to.size(); ++v) equal_to[v] = *different.insert(v).first;
  return equal_to;
}

}  // namespace radiosity
