// The values of glTF vertex attributes where edges are cut.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/mesh/refined_mesh.h"
#include "plugin/accessor_view.h"

namespace gltf_radiosity {

enum class Interpolation {
  kLinear,     ///< between those of the two ends
  kDirection,  ///< the same, then unit length: NORMAL
  kTangent,    ///< the same for x, y and z; the sign w is that of the nearer end, the first of two equally near
  kLabel       ///< the value of that end: integers that name something have no mean
};

/// How the attribute `semantic` ("NORMAL", "_FEATURE_ID_0") is carried to a cut.
Interpolation interpolation_of(std::string_view semantic, const RawAccessor& raw);

/// The rows `rows` of `source`, exact bytes; all of them if `rows` is empty.
RawAccessor picked(RawAccessor source, std::span<const std::uint32_t> rows);

/// Appends a row for each cut: its ends are rows of `raw`, or cuts before it. Existing bytes stay.
void append_cuts(RawAccessor& raw, Interpolation how, std::span<const radiosity::Cut> cuts);

/// JOINTS_n and WEIGHTS_n of one primitive.
struct SkinSet {
  RawAccessor joints, weights;
};

/// Appends a row for each cut to all sets together: the joints of both ends with the mean of their weights, by
/// distance, the strongest four per set kept, strongest first, scaled to a sum of exactly 1 in the stored type.
void append_cuts(std::vector<SkinSet>& sets, std::span<const radiosity::Cut> cuts);

}  // namespace gltf_radiosity
