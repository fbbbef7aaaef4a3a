// What the vertices of a display mesh carry besides their place, and how much of it may change unseen.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/rgb.h"

namespace radiosity {

/// Shapes: per vertex [vertex_count]. Vertices of one element carry equally many values.
struct Carried {
  std::vector<std::size_t> first_value;  ///< [vertex_count + 1], into `values`
  std::vector<float> values;             ///< linear within elements; each in units of what it may change by
  std::vector<std::uint32_t> label;    ///< what has no mean, as a number: equal within elements, or nothing is removed
  std::vector<Rgb> light;              ///< what shows
  std::vector<float> light_tolerance;  ///< luminance may change by this much, each band by twice as much; > 0
  std::vector<float> shape_tolerance;  ///< metres that the surface may move here; > 0
  std::vector<std::uint8_t> fixed;     ///< 1 where the vertex has to stay

  std::span<const float> values_of(std::uint32_t vertex) const {
    return std::span(values).subspan(first_value[vertex], first_value[vertex + 1] - first_value[vertex]);
  }
};

/// Which vertex stands for each, [vertex_count]: the first at its position that carries exactly the same.
std::vector<std::uint32_t> find_equal_vertices(std::span<const std::uint32_t> class_of_vertex, const Carried& carried);

}  // namespace radiosity
