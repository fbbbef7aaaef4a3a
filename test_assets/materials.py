"""Materials that are more than a base colour, in closed forms."""

import math

from features import LOOKING_DOWN
from gltf_builder import GltfBuilder
from png import png
from shapes import box, floor


def panes():
    """A floor under a sun of pi lux, half of it below clear glass and half below glass that keeps half of the light.

    The floor is of specular-glossiness with a texture. A roof, a lamp on it, and what hangs below it are invisible.
    """
    gltf = GltfBuilder()
    for name in ("pbrSpecularGlossiness", "transmission"):
        gltf.use_extension(f"KHR_materials_{name}")
    grey = gltf.texture(png(1, 1, lambda x, y: (188, 188, 188)), name="grey")  # 0.503 in linear light
    glossy = {"diffuseTexture": {"index": grey}, "specularFactor": [0.04, 0.04, 0.04], "glossinessFactor": 0.5}
    stone = gltf.material("stone", (1, 0, 0), extensions={"KHR_materials_pbrSpecularGlossiness": glossy})
    gltf.solid("floor", floor(-2, -1, 2, 1, cells=(16, 8)), stone, uvs=True)
    clear = gltf.material("clear", (0.8, 0.8, 0.8), extensions={"KHR_materials_transmission": {"transmissionFactor": 1}})
    gltf.solid("clear_pane", floor(-2, -1, 0, 1, y=1), clear)
    half = gltf.material("half", extensions={"KHR_materials_transmission": {"transmissionFactor": 0.5}})
    gltf.solid("half_pane", floor(0, -1, 2, 1, y=1.2), half)
    gltf.node("sun", rotation=LOOKING_DOWN, extensions=gltf.light("sun", "directional", math.pi))
    _invisible_roof(gltf)
    return gltf


def _invisible_roof(gltf):
    gltf.use_extension("KHR_node_visibility")
    wood = gltf.material("wood", (0.4, 0.3, 0.2))
    hidden = {"KHR_node_visibility": {"visible": False}}
    roof = gltf.solid("roof", box((-3, 2, -2), (3, 2.1, 2)), wood, extensions=hidden)
    shown = {"KHR_node_visibility": {"visible": True}}
    gltf.solid("beam", box((-3, 1.8, -0.1), (3, 2, 0.1)), wood, parent=roof, extensions=shown)
    gltf.node("lamp", parent=roof, translation=[0, -1.5, 0], extensions=gltf.light("lamp", "point", 100))
