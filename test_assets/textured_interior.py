"""A small room in which every kind of texture and alpha mode takes part in the light."""

from gltf_builder import CLAMP_TO_EDGE, MIRRORED_REPEAT, REPEAT, GltfBuilder
from png import png
from shapes import box, floor, quad


def _tiles(x, y):
    """Two by two tiles of terracotta and cream."""
    return (226, 214, 190) if (x < 32) == (y < 32) else (168, 84, 58)


def _stripes(x, y):
    return (188, 205, 190) if x < 8 else (110, 150, 140)


def _painting(x, y):
    """A yellow disc on blue, so that wrap modes show."""
    return (240, 200, 40) if (x - 20) ** 2 + (y - 24) ** 2 < 144 else (40, 70, 150)


def _sign(x, y):
    """A lit ring on black: most of the panel does not shine."""
    distance = (x - 15.5) ** 2 + (y - 15.5) ** 2
    return (255, 120, 60) if 49 < distance < 196 else (0, 0, 0)


def _fence(x, y):
    """Pickets two thirds of the way: opaque for 5 of 8 columns, and a rail."""
    opaque = x % 8 < 5 or 12 <= y < 18
    return (150, 110, 70, 255 if opaque else 0)


def _walls(gltf):
    walls = gltf.texture(png(16, 16, _stripes), name="stripes")
    # Twice as fine, moved and turned: a reader that drops the transform puts the stripes elsewhere.
    transform = {"offset": [0.25, 0.5], "rotation": 0.3, "scale": [2.0, 2.0]}
    gltf.use_extension("KHR_texture_transform")
    paper = gltf.material("striped_paper")
    gltf.json["materials"][paper]["pbrMetallicRoughness"]["baseColorTexture"] = {
        "index": walls,
        "extensions": {"KHR_texture_transform": transform},
    }
    gltf.solid("walls", box((0, 0, 0), (4, 2.6, 3), inward=True, sides="xXzZ"), paper, uvs=True)
    gltf.solid("ceiling", box((0, 0, 0), (4, 2.6, 3), inward=True, sides="Y"), gltf.material("white", (0.8, 0.8, 0.8)))
    tiles = gltf.material("tiles", (0.9, 0.9, 0.9))
    gltf.json["materials"][tiles]["pbrMetallicRoughness"]["baseColorTexture"] = {
        "index": gltf.texture(png(64, 64, _tiles), (REPEAT, REPEAT), name="tiles")
    }
    gltf.solid("floor", floor(0, 0, 4, 3), tiles, uvs=True)


def _paintings(gltf):
    """One painting, three wrap modes: the quads' uvs run from 0 to 2."""
    for index, (name, wrap) in enumerate(
        [("clamped", CLAMP_TO_EDGE), ("mirrored", MIRRORED_REPEAT), ("repeated", REPEAT)]
    ):
        material = gltf.material(f"painting_{name}")
        gltf.json["materials"][material]["pbrMetallicRoughness"]["baseColorTexture"] = {
            "index": gltf.texture(png(48, 48, _painting), (wrap, wrap), name=f"painting_{name}")
        }
        x = 0.5 + 1.1 * index
        corners = [(x, 1, 0.01), (x + 0.8, 1, 0.01), (x + 0.8, 1.8, 0.01), (x, 1.8, 0.01)]
        gltf.solid(f"painting_{name}", quad(corners, uv_size=(2, 2)), material, uvs=True)


def _shining(gltf):
    sign = gltf.material("sign", (0.02, 0.02, 0.02), [6.0, 6.0, 6.0])
    gltf.json["materials"][sign]["emissiveTexture"] = {
        "index": gltf.texture(png(32, 32, _sign), (CLAMP_TO_EDGE, CLAMP_TO_EDGE), name="sign")
    }
    corners = [(0.01, 1.2, 2.2), (0.01, 1.2, 1.4), (0.01, 2.0, 1.4), (0.01, 2.0, 2.2)]
    gltf.solid("sign", quad(corners), sign, uvs=True)
    lamp = gltf.material("lamp", (0.8, 0.8, 0.8), [12.0, 11.0, 9.0])
    gltf.solid("lamp", box((1.7, 2.45, 1.2), (2.3, 2.5, 1.8)), lamp)


def _see_through(gltf):
    fence = gltf.material("fence", alphaMode="MASK", alphaCutoff=0.5, doubleSided=True)
    gltf.json["materials"][fence]["pbrMetallicRoughness"]["baseColorTexture"] = {
        "index": gltf.texture(png(32, 32, _fence, channels=4), (REPEAT, REPEAT), name="fence")
    }
    corners = [(2.9, 0, 2.6), (2.9, 0, 0.4), (2.9, 0.9, 0.4), (2.9, 0.9, 2.6)]
    gltf.solid("fence", quad(corners, uv_size=(2, 1)), fence, uvs=True)
    pane = gltf.material("pane", (0.3, 0.6, 0.9), alpha=0.4, alphaMode="BLEND", doubleSided=True)
    gltf.solid("pane", quad([(0.4, 0.4, 0.9), (1.2, 0.4, 0.9), (1.2, 1.1, 0.9), (0.4, 1.1, 0.9)]), pane)


def textured_interior():
    gltf = GltfBuilder()
    _walls(gltf)
    _paintings(gltf)
    _shining(gltf)
    _see_through(gltf)
    gltf.solid("table", box((1.5, 0.7, 0.8), (2.5, 0.75, 1.6)), gltf.material("wood", (0.45, 0.28, 0.15)))
    gltf.camera("corner", (2, 1.4, 2.95), 75)
    return gltf
