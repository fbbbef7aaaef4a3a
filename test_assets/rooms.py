"""Rooms whose light is known without computing it, or nearly so."""

from gltf_builder import GltfBuilder
from shapes import box, floor


def white_furnace(reflectance, luminance):
    """A closed cube that glows and reflects evenly everywhere: L = luminance / (1 - reflectance), whatever its size."""
    gltf = GltfBuilder()
    material = gltf.material("furnace", [reflectance] * 3, [luminance] * 3)
    gltf.solid("furnace", box((0, 0, 0), (1, 1, 1), inward=True, cells=(6, 6, 6)), material)
    return gltf


def two_rooms():
    """One shell 4.1 m long, a wall of 10 cm across its middle, a lamp in the western half. The east must stay black.

          0          2.0 2.1         4.1
          +-----------+--+-----------+      The floor runs through below the wall, so that triangles
          |    lamp   |  |           |      which are lit at one end lie in the dark at the other.
          +-----------+--+-----------+
    """
    gltf = GltfBuilder()
    grey = gltf.material("grey", (0.5, 0.5, 0.5))
    gltf.solid("shell", box((0, 0, 0), (4.1, 2, 2), inward=True, cells=(41, 20, 20)), grey)
    gltf.solid("wall", box((2, 0, 0), (2.1, 2, 2), cells=(1, 10, 10), sides="xX"), grey)
    lamp = gltf.material("lamp", (0, 0, 0), [20, 20, 20])
    gltf.solid("lamp", box((0.8, 1.9, 0.8), (1.2, 1.95, 1.2)), lamp)
    return gltf


def sky_court():
    """A yard between four walls, open above, with nothing that shines: only a sky lights it."""
    gltf = GltfBuilder()
    ground = gltf.material("ground", (0.4, 0.35, 0.3))
    plaster = gltf.material("plaster", (0.7, 0.68, 0.62))
    brick = gltf.material("brick", (0.5, 0.18, 0.1))
    gltf.solid("ground", floor(-5, -5, 5, 5, cells=(10, 10)), ground)
    gltf.solid("north_wall", box((-5, 0, -5.3), (5, 4, -5), sides="xXYzZ"), plaster)
    gltf.solid("south_wall", box((-5, 0, 5), (5, 4, 5.3), sides="xXYzZ"), plaster)
    gltf.solid("west_wall", box((-5.3, 0, -5.3), (-5, 4, 5.3), sides="xXYzZ"), brick)
    gltf.solid("east_wall", box((5, 0, -5.3), (5.3, 4, 5.3), sides="xXYzZ"), plaster)
    gltf.solid("well", box((-1.5, 0, -1.5), (0, 1, 0), sides="xXYzZ"), plaster)
    gltf.camera("from_above", (0, 3, 4.9), 60)
    return gltf
