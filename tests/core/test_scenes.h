// Small scenes in code, each named after what it shows. Metres; y is up.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>

#include "core/scene.h"

namespace radiosity::test {

/// A closed box from the origin to `size`, seen from inside: normals point inward. Twelve triangles with one surface;
/// wall k is triangles 2k and 2k+1 on its own four vertices, in the order -x, +x, -y (floor), +y (ceiling), -z, +z.
/// Opposite walls are k and k^1.
Scene box_room(const glm::vec3& size, const Surface& surface);

/// The unit cube from inside, each face with a surface of its own (dark grey, no emission), numbered like box_room.
/// Form factors: 0.199825 to the opposite face, 0.200044 to each of the others.
Scene unit_cube_faces();

/// Two unit squares facing each other: 0 at z = 0, 1 at z = `distance`. Square k is triangles 2k and 2k+1 with surface
/// k; square 0 emits 1 cd/m2 and reflects nothing, square 1 reflects a half.
Scene parallel_squares(float distance);

/// Two unit squares meeting at the x axis, at a right angle: 0 lies in y = 0, 1 stands in z = 0. Numbered and lit like
/// parallel_squares. Form factor 0.200044.
Scene perpendicular_squares();

/// The Cornell box as measured, in metres: open front at z = 0, two turned blocks, a lamp of 17, 12, 4 cd/m2 a
/// millimetre below the ceiling (0.13 m x 0.105 m). The red wall is at large x. Surfaces: 0 white, 1 red, 2 green,
/// 3 lamp. https://www.graphics.cornell.edu/online/box/data.html
Scene cornell_box();

/// A closed unit box whose walls all reflect `rho` and emit `luminance` cd/m2: every point shows
/// luminance / (1 - rho) in every direction.
Scene white_furnace(float rho, float luminance);

/// A floor 4 m wide at y = 0, a black two-sided square 1 m wide at y = 1, a lamp 0.5 m wide at y = 2 that shines down
/// with 100 cd/m2; all centred on the y axis, two triangles and one surface each, in this order. The floor is in full
/// shadow where |x| and |z| are below 0.75, and unshadowed where either is above 1.25.
Scene occluder();

/// The floor of the occluder scene alone: 4 m wide, facing up.
Scene floor_only();

/// A box of 1 m seen from outside: from inside there are only backs.
Scene solid_box();

/// A room of 2 m x 1 m x 1 m with white walls, cut in two by a wall from x = `wall` to `wall + thickness` and lit by a
/// point of 1 cd in the middle of the left part. Floor, ceiling and the long walls go through in one piece. Walls are
/// numbered like box_room, the two sides of the dividing wall come last; one surface.
Scene rooms_on_one_floor(float wall, float thickness);

/// The floor under a sun of 10 lx straight above, and a closed box seen from outside that is sunk into it, 1 m wide
/// and 0.5 m above and below the floor, middle at x = 0.13, z = -0.21. Surfaces: 0 floor, 1 box; both reflect `rho`.
Scene sunk_box(float rho);

/// The same floor under the same sun, and a two-sided wall through it in the plane x = 0.13, 0.5 m above and below,
/// across the whole width. Surfaces: 0 floor, 1 wall; both reflect `rho`.
Scene wall_through_floor(float rho);

/// A wall 2 m wide in the plane z = 0 and a panel 0.5 m wide `gap` metres in front of it, both towards +z and centred
/// on the z axis; two triangles and one surface each, in this order.
Scene panel_before_wall(float gap);

/// A room 10 m x 4 m x 10 m with `count` boxes of random size, turned about y, and a lamp below the ceiling: for
/// comparing makers of visibility. Boxes may overlap. The same `seed` gives the same scene everywhere.
Scene many_boxes(int count, std::uint32_t seed);

/// A scene and what answers for its varying surfaces.
struct DetailedScene {
  std::unique_ptr<SurfaceDetail> detail;
  Scene scene;
};

/// The occluder scene with a fence instead of the square: stripes 0.125 m wide along z, opaque where
/// floor(x / 0.125) is even. Exactly half of the fence is opaque.
DetailedScene see_through_fence();

/// `scene` with every triangle cut into n x n, conforming: triangle t becomes triangles t n^2 .. (t + 1) n^2 - 1.
/// REQUIRES: n >= 1, and no surface varies or is see-through (details speak of the uncut triangles).
Scene tessellated(const Scene& scene, int n);

}  // namespace radiosity::test
