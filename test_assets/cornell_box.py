"""The Cornell box, as measured at Cornell University (graphics.cornell.edu/online/box/data.html).

Goral, Torrance, Greenberg and Battaile. Modeling the Interaction of Light Between Diffuse Surfaces. 1984, and the
measurements of 1998. Millimetres become metres. The spectra become the linear Rec. 709 reflectances in common use.
"""

import math

from gltf_builder import GltfBuilder
from shapes import Shape, quad

WHITE = (0.725, 0.71, 0.68)
RED = (0.63, 0.065, 0.05)
GREEN = (0.14, 0.45, 0.091)
LAMP_REFLECTANCE = (0.78, 0.78, 0.78)
# The lamp's colour in common use is (17, 12, 4) in arbitrary units. Half as much again suits an exposure of 1 m2/cd.
LAMP_LUMINANCE = (25.5, 18.0, 6.0)

# The lamp hangs 1 mm below the ceiling.
_Y = 547.8

WALLS = {
    "floor": (WHITE, [(552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2)]),
    "ceiling": (WHITE, [(556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0)]),
    "back_wall": (WHITE, [(549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2)]),
    "green_wall": (GREEN, [(0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)]),
    "red_wall": (RED, [(552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0)]),
}
LAMP = [(343, _Y, 227), (343, _Y, 332), (213, _Y, 332), (213, _Y, 227)]
# The top of each block, counter-clockwise seen from above; the sides go straight down.
BLOCKS = {
    "short_block": (165, [(130, 65), (82, 225), (240, 272), (290, 114)]),
    "tall_block": (330, [(423, 247), (265, 296), (314, 456), (472, 406)]),
}


def _metres(corners):
    return [tuple(x / 1000 for x in corner) for corner in corners]


def _block_faces(height, outline):
    """The top and four sides; the bottom stands on the floor."""
    faces = [[(x, height, z) for x, z in outline]]
    for (x0, z0), (x1, z1) in zip(outline, outline[1:] + outline[:1]):
        faces.append([(x0, height, z0), (x0, 0, z0), (x1, 0, z1), (x1, height, z1)])
    return faces


def _cells(corners, spacing):
    """How often to cut a quad so that its cells are about `spacing` metres wide; once if that is 0."""

    def count(start, end):
        return max(1, round(math.dist(corners[start], corners[end]) / spacing))

    return (count(0, 1), count(1, 2)) if spacing else (1, 1)


def _quads(spacing):
    """(name, colour, emission, corners in metres, cells) of each face."""
    # The walls are all cut alike, so that no vertex lies on a neighbour's edge.
    wall_cells = max(1, round(0.556 / spacing)) if spacing else 1
    for name, (color, corners) in WALLS.items():
        yield name, color, None, _metres(corners), (wall_cells, wall_cells)
    for name, (height, outline) in BLOCKS.items():
        for face in map(_metres, _block_faces(height, outline)):
            yield name, WHITE, None, face, _cells(face, spacing)
    yield "lamp", LAMP_REFLECTANCE, LAMP_LUMINANCE, _metres(LAMP), _cells(_metres(LAMP), spacing)


def _vertex_count(spacing):
    return sum((columns + 1) * (rows + 1) for *_, (columns, rows) in _quads(spacing))


def _spacing_for(vertices):
    """The spacing, in metres, whose vertex count comes nearest to `vertices`."""
    tenths_of_millimetres = range(80, 2000)
    return min((step / 10000 for step in tenths_of_millimetres), key=lambda s: abs(_vertex_count(s) - vertices))


def cornell_box(vertices=None):
    """The box with two triangles for each face, or cut into a regular grid of about `vertices` vertices."""
    gltf = GltfBuilder()
    objects = {}
    for name, color, emission, corners, cells in _quads(_spacing_for(vertices) if vertices else 0):
        shape, _, _ = objects.setdefault(name, (Shape(), color, emission))
        shape.add(quad(corners, cells))
    labels = {WHITE: "white", RED: "red", GREEN: "green", LAMP_REFLECTANCE: "lamp"}
    materials = {}
    for name, (shape, color, emission) in objects.items():
        if color not in materials:
            materials[color] = gltf.material(labels[color], color, emission)
        gltf.solid(name, shape, materials[color])
    gltf.camera("front", (0.278, 0.273, -0.8), 39.3077, turn_degrees=180)
    return gltf
