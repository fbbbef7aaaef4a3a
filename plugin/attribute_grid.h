// How exactly compressed floats are kept: on grids whose steps are powers of two.
//
// Whole multiples of a power of two are floats without rounding, in every decoder. So vertices at one position stay at
// one position, whichever primitives they belong to: no crack opens where primitives, or nodes placed alike, meet.
#pragma once

#include <optional>
#include <string_view>

namespace gltf_radiosity {

/// The step of the grid that positions of a mesh are rounded to, as a power of two: 2^18 steps over the longest edge of
/// the bounding box of the file's largest mesh, but at least 2^14 over that of the mesh itself. In the mesh's own
/// units. REQUIRES: neither is negative.
int position_grid(float mesh_extent, float largest_extent);

/// The same for any attribute of floats; none if it must be kept bit by bit: what an application made of its own.
/// Texture coordinates are kept to 1/65536 whatever their range.
std::optional<int> attribute_grid(std::string_view semantic, int position_grid);

/// Whether a 24-bit whole number times the step can hold `value`.
bool fits_grid(float value, int exponent);

}  // namespace gltf_radiosity
