"""A room with a lamp and bumpy spheres, of any number of triangles up to millions, made in seconds.

    python3 bumpy_spheres.py OUT.glb TRIANGLES
"""

import array
import math
import pathlib
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "test_assets"))

from gltf_builder import ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER, FLOAT, UNSIGNED_INT, GltfBuilder  # noqa: E402
from shapes import box, quad  # noqa: E402

ROOM = (10.0, 4.0, 10.0)
GREY, CLAY = (0.7, 0.7, 0.7), (0.6, 0.4, 0.3)


def write_bumpy_spheres(path, triangles):
    """About `triangles` in all; more triangles are both more spheres and finer ones."""
    spheres = max(8, round(math.sqrt(triangles) / 10))
    gltf = GltfBuilder()
    room = box((0, 0, 0), ROOM, inward=True, cells=(5, 2, 5))
    gltf.solid("room", room, gltf.material("grey", GREY))
    lamp = quad([(4, 3.99, 4), (6, 3.99, 4), (6, 3.99, 6), (4, 3.99, 6)], (2, 2))
    gltf.solid("lamp", lamp, gltf.material("lamp", GREY, (20, 20, 20)))
    clay = gltf.material("clay", CLAY)
    columns = max(4, round(math.sqrt((triangles - len(room.indices) // 3) / spheres)))
    parts = _bumpy_sphere(columns)
    for number, (place, radius, turn) in enumerate(_places(spheres)):
        mesh = gltf.mesh(f"sphere {number}", _primitive(gltf, parts, clay))
        rotation = [0, math.sin(turn / 2), 0, math.cos(turn / 2)]
        gltf.node(f"sphere {number}", mesh=mesh, translation=place, rotation=rotation, scale=[radius] * 3)
    gltf.save_glb(path)


def _bumpy_sphere(columns):
    """(positions, normals, indices, lowest and highest corner) of about columns^2 triangles."""
    rows = max(3, columns // 2)
    positions, normals, indices = array.array("f"), array.array("f"), array.array("I")
    for j in range(rows + 1):
        polar = math.pi * j / rows
        for i in range(columns + 1):
            around = 2 * math.pi * i / columns
            outward = (math.sin(polar) * math.cos(around), math.cos(polar), -math.sin(polar) * math.sin(around))
            # The normals are those of the sphere; the bumps are shallow.
            bump = 1 + 0.03 * math.sin(9 * around) * math.sin(7 * polar) * math.sin(polar)
            positions.extend(bump * x for x in outward)
            normals.extend(outward)
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            b, c, d = a + columns + 1, a + columns + 2, a + 1
            # At a pole one of the two has no area.
            indices.extend((a, b, c) if j < rows - 1 else ())
            indices.extend((a, c, d) if j > 0 else ())
    bounds = [[edge(positions[axis::3]) for axis in range(3)] for edge in (min, max)]
    return positions, normals, indices, bounds


def _primitive(gltf, parts, material):
    """Every sphere gets its own bytes: a file of n triangles, not one of few triangles and n instances."""
    positions, normals, indices, (low, high) = parts
    attributes = {}
    for name, data, more in (("POSITION", positions, {"min": low, "max": high}), ("NORMAL", normals, {})):
        attributes[name] = _accessor(gltf, data, FLOAT, "VEC3", 3, ARRAY_BUFFER, more)
    index = _accessor(gltf, indices, UNSIGNED_INT, "SCALAR", 1, ELEMENT_ARRAY_BUFFER, {})
    return {"attributes": attributes, "indices": index, "material": material}


def _accessor(gltf, data, component, kind, width, target, more):
    view = gltf.buffer_view(memoryview(data).cast("B"), target)
    accessor = {"bufferView": view, "componentType": component, "count": len(data) // width, "type": kind, **more}
    gltf.json.setdefault("accessors", []).append(accessor)
    return len(gltf.json["accessors"]) - 1


def _places(count):
    """Centre, radius and turn of spheres that do not touch: a grid with a little disorder."""
    layers = 2 if count > 16 else 1
    side = math.ceil(math.sqrt(count / layers))
    cell = min(ROOM[0] / side, 3.0 / layers)
    for number in range(count):
        layer, rest = divmod(number, side * side)
        k, i = divmod(rest, side)
        disorder = [0.2 * cell * (math.modf((number + 1) * ratio)[0] - 0.5) for ratio in (0.618034, 0.754878, 0.569840)]
        grid = ((i + 0.5) * ROOM[0] / side, (layer + 0.5) * 3.0 / layers, (k + 0.5) * ROOM[2] / side)
        yield [g + d for g, d in zip(grid, disorder)], 0.36 * cell, 2.4 * number


if __name__ == "__main__":
    write_bumpy_spheres(pathlib.Path(sys.argv[1]), int(sys.argv[2]))
