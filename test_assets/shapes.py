"""Triangles with normals and texture coordinates: quads, boxes, cylinders."""

import math


class Shape:
    """Parallel lists of positions, normals and uvs (tuples), and indices of triangles, three each."""

    def __init__(self):
        self.positions, self.normals, self.uvs, self.indices = [], [], [], []

    def add(self, other):
        first = len(self.positions)
        self.positions += other.positions
        self.normals += other.normals
        self.uvs += other.uvs
        self.indices += [first + index for index in other.indices]
        return self


def subtract(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return tuple(x / length for x in a)


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def quad(corners, cells=(1, 1), uv_size=(1.0, 1.0)):
    """Four corners, counter-clockwise seen from the front, cut into cells.

       3 ------- 2        v
       |  .   /  |        ^
       |   /  .  |        |      Points stay on the two triangles 0 1 2 and 0 2 3, so that the surface of a
       0 ------- 1        o-> u  twisted quad does not depend on how finely it is cut (if cells are square).
    """
    p0, p1, p2, p3 = corners
    columns, rows = cells
    normal = unit(cross(subtract(p2, p0), subtract(p3, p1)))
    shape = Shape()
    for j in range(rows + 1):
        for i in range(columns + 1):
            u, v = i / columns, j / rows
            # Below the diagonal u runs along 0 1 and v along 1 2, above it v along 0 3 and u along 3 2.
            along = [(p0, p1, u), (p1, p2, v)] if u >= v else [(p0, p3, v), (p3, p2, u)]
            point = list(p0)
            for start, end, share in along:
                point = [x + (e - s) * share for x, s, e in zip(point, start, end)]
            shape.positions.append(tuple(point))
            shape.normals.append(normal)
            shape.uvs.append((u * uv_size[0], (1 - v) * uv_size[1]))
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            b, c, d = a + 1, a + columns + 2, a + columns + 1
            shape.indices += [a, b, c, a, c, d]
    return shape


def box(low, high, inward=False, cells=(1, 1, 1), sides="xXyYzZ"):
    """An axis-aligned box; `sides` names the faces to make, x at the low end, X at the high one."""
    (x, y, z), (X, Y, Z) = low, high
    nx, ny, nz = cells
    faces = {
        "x": ([(x, y, z), (x, y, Z), (x, Y, Z), (x, Y, z)], (nz, ny), (Z - z, Y - y)),
        "X": ([(X, y, Z), (X, y, z), (X, Y, z), (X, Y, Z)], (nz, ny), (Z - z, Y - y)),
        "y": ([(x, y, z), (X, y, z), (X, y, Z), (x, y, Z)], (nx, nz), (X - x, Z - z)),
        "Y": ([(x, Y, Z), (X, Y, Z), (X, Y, z), (x, Y, z)], (nx, nz), (X - x, Z - z)),
        "z": ([(X, y, z), (x, y, z), (x, Y, z), (X, Y, z)], (nx, ny), (X - x, Y - y)),
        "Z": ([(x, y, Z), (X, y, Z), (X, Y, Z), (x, Y, Z)], (nx, ny), (X - x, Y - y)),
    }
    shape = Shape()
    for side in sides:
        corners, face_cells, uv_size = faces[side]
        # Seen from within, the same face runs the other way round; uvs are in metres.
        corners = [corners[1], corners[0], corners[3], corners[2]] if inward else corners
        shape.add(quad(corners, face_cells, uv_size))
    return shape


def floor(low_x, low_z, high_x, high_z, y=0.0, cells=(1, 1)):
    """A horizontal rectangle that faces up."""
    corners = [(low_x, y, high_z), (high_x, y, high_z), (high_x, y, low_z), (low_x, y, low_z)]
    return quad(corners, cells, (high_x - low_x, high_z - low_z))


def cylinder(radius, height, columns, rows):
    """An open tube about +Y with smooth normals. Column 0 and the last one share positions, not uvs: a seam."""
    shape = Shape()
    for j in range(rows + 1):
        for i in range(columns + 1):
            angle = 2 * math.pi * (i % columns) / columns
            normal = (math.sin(angle), 0.0, math.cos(angle))
            shape.positions.append((radius * normal[0], height * j / rows, radius * normal[2]))
            shape.normals.append(normal)
            shape.uvs.append((i / columns, 1 - j / rows))
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            b, c, d = a + 1, a + columns + 2, a + columns + 1
            shape.indices += [a, b, c, a, c, d]
    return shape
