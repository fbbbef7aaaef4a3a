// The values of glTF vertex attributes at midpoints of edges.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "plugin/accessor_view.h"

namespace gltf_radiosity {

enum class Interpolation {
  kLinear,     ///< mean of the two ends
  kDirection,  ///< mean, then unit length: NORMAL
  kTangent,    ///< the same for x, y and z; the sign w is the first end's
  kLabel       ///< the first end's value: integers that name something have no mean
};

/// How the attribute `semantic` ("NORMAL", "_FEATURE_ID_0") is carried to a midpoint.
Interpolation interpolation_of(std::string_view semantic, const RawAccessor& raw);

/// The rows `rows` of `source`, exact bytes; all of them if `rows` is empty.
RawAccessor picked(RawAccessor source, std::span<const std::uint32_t> rows);

/// Appends a row for each midpoint: `ends` are rows of `raw`, or midpoints before it. Existing bytes stay.
void append_midpoints(RawAccessor& raw, Interpolation how, std::span<const glm::uvec2> ends);

/// JOINTS_n and WEIGHTS_n of one primitive.
struct SkinSet {
  RawAccessor joints, weights;
};

/// Appends a row for each midpoint to all sets together: the joints of both ends with the mean of their weights, the
/// strongest four per set kept, strongest first, scaled to a sum of exactly 1 in the stored type.
void append_midpoints(std::vector<SkinSet>& sets, std::span<const glm::uvec2> ends);

}  // namespace gltf_radiosity
