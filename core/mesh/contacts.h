// Where one surface stands on another, or passes through it: lines along which light jumps.
//
//      lit  |  dark            The wall ends on the floor, or below it, and no edge of the floor need lie there. Light
//           |                  that is linear in each element cannot jump inside one.
//     ______|_______
//
// Only contacts that part what shows count: below a box that stands on the floor all samples are buried, and what a
// vertex there shows is free. But a wall of two sheets with nothing between them parts the rooms on either side.
//
// Heckbert. Discontinuity Meshing for Radiosity. 1992
// Lischinski, Tampieri and Greenberg. Discontinuity Meshing for Accurate Radiosity. 1992
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/progress.h"
#include "core/visibility/ray_scene.h"

namespace radiosity {

/// A straight line on the front of a triangle where another surface starts.
struct Contact {
  std::uint32_t triangle = kNothing;
  glm::dvec3 from{0.0}, to{0.0};  ///< metres, on the triangle
  bool shows_both_sides = true;   ///< otherwise one side is buried
};

struct ContactOptions {
  float patch_size = 0.0F;  ///< smaller triangles and shorter lines are not looked at, metres, > 0
  /// Triangles of a level of their own, as in SubdivideOptions, are left out.
  std::span<const std::int8_t> level_of_triangle;
};

/// All contacts, by ascending triangle. Pieces of one line are joined. See-through surfaces have none. Parallel;
/// deterministic; throws `Cancelled`.
std::vector<Contact> find_contacts(const RayScene& rays, const ContactOptions& options, const Progress& progress);

}  // namespace radiosity
