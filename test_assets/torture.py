"""Everything that a bake could lose, in one file: torture.gltf."""

from extras import UNKNOWN, decorate
from features import skinned_strip
from gltf_builder import LINES, POINTS, UNSIGNED_SHORT, GltfBuilder
from png import png
from shapes import Shape, floor, quad


def _images(gltf, folder):
    """One in the buffer, one as a data URI, one in a file whose name must be percent-encoded. All are one picture."""
    picture = png(4, 4, lambda x, y: (200, 40 * x, 40 * y))
    (folder / "torture images").mkdir(exist_ok=True)
    (folder / "torture images" / "grün & 50%.png").write_bytes(picture)
    inside = gltf.texture(picture, name="inside")
    encoded = gltf.texture(None, uri=gltf.data_uri("image/png", picture), name="encoded")
    outside = gltf.texture(None, uri="torture%20images/gr%C3%BCn%20%26%2050%25.png", name="grün ❤")
    return inside, encoded, outside


def _materials(gltf, textures):
    inside, encoded, outside = textures
    baked = gltf.material("baked", emissiveFactor=[0, 0.1, 0], normalTexture={"index": inside, "scale": 0.5})
    gltf.json["materials"][baked]["pbrMetallicRoughness"]["baseColorTexture"] = {"index": outside}
    sign = gltf.material("sign", (0.9, 0.2, 0.1), extensions={"KHR_materials_unlit": {}})
    # What only the other scene uses keeps all that a baked material loses.
    rich = gltf.material("rich", alphaMode="BLEND", emissiveFactor=[1, 1, 1], emissiveTexture={"index": encoded})
    gltf.json["materials"][rich].update(
        normalTexture={"index": inside}, occlusionTexture={"index": outside, "strength": 0.25},
        extensions={"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatTexture": {"index": encoded}}},
    )
    for name in ("unlit", "clearcoat", "variants"):
        gltf.use_extension(f"KHR_materials_{name}")
    return baked, sign, rich


def _points_and_lines(gltf, material):
    dots = Shape()
    dots.positions = [(x / 4, 0.5, 0.0) for x in range(-4, 5)]
    dots.indices = list(range(8))
    points = gltf.primitive(dots, material, mode=POINTS, indexed=False)
    return gltf.node("dots", mesh=gltf.mesh("dots", points, gltf.primitive(dots, material, mode=LINES, buffer=1)))


def _morphed(gltf, material):
    """A plane whose morph target is a sparse accessor without a bufferView."""
    primitive = gltf.primitive(floor(-1, -1, 1, 1, cells=(2, 2)), material, uvs=True, buffer=1)
    indices = gltf.buffer_view(bytes((1, 0, 4, 0)))
    values = gltf.buffer_view(bytes(24))
    sparse = {
        "count": 2,
        "indices": {"bufferView": indices, "componentType": UNSIGNED_SHORT},
        "values": {"bufferView": values},
    }
    primitive["targets"] = [{"POSITION": gltf.sparse_accessor(9, "VEC3", sparse)}]
    return gltf.mesh("morphed", primitive, weights=[0.25], extras={"targetNames": ["höher"]})


def _animate(gltf, plane, joint, material):
    """A node, a skin's joint, and by pointers a material that is baked and whether a node is visible."""
    gltf.use_extension("KHR_animation_pointer")
    times = gltf.accessor([0, 2], bounds=True, target=None)
    moves = gltf.accessor([(0, 0, 0), (0, 0.5, 0)], target=None, buffer=1)

    def pointer(path):
        return {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": path}}}

    targets = [
        {"node": plane, "path": "translation"},
        {"node": joint, "path": "scale"},
        pointer(f"/materials/{material}/emissiveFactor"),
    ]
    gltf.json["animations"] = [
        {
            "name": "",
            "samplers": [{"input": times, "output": moves, "interpolation": "STEP"}],
            "channels": [{"sampler": 0, "target": target} for target in targets],
        }
    ]


def _other_scene(gltf, mesh, rich):
    """Shares a mesh with the first, and has one of its own."""
    own = gltf.mesh("own", gltf.primitive(quad([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]), rich, uvs=True))
    first = len(gltf.json["nodes"])
    gltf.json["nodes"] += [{}, {"name": "shared", "mesh": mesh}, {"name": "own", "mesh": own, "children": [first]}]
    gltf.json["scenes"].append({"name": "other", "nodes": [first + 1, first + 2]})


def torture(folder):
    gltf = GltfBuilder()
    baked, sign, rich = _materials(gltf, _images(gltf, folder))
    mesh = _morphed(gltf, baked)
    plane = gltf.node("plane", mesh=mesh, weights=[0.0])
    gltf.node("again", mesh=mesh, translation=[3, 0, 0])
    board = gltf.primitive(quad([(0, 0.2, 0), (0.5, 0.2, 0), (0.5, 0.7, 0), (0, 0.7, 0)]), sign)
    board["extensions"] = {"KHR_materials_variants": {"mappings": [{"material": rich, "variants": [0]}]}}
    gltf.node("sign", mesh=gltf.mesh("sign", board))
    _points_and_lines(gltf, sign)
    joint = skinned_strip(gltf, gltf.material("skin", (0.6, 0.6, 0.6), doubleSided=True))
    gltf.camera("camera", (0, 1, 3), 45)
    flat = {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 9}}
    gltf.json["cameras"].append(flat)
    gltf.node("flat", camera=1)
    gltf.node("lamp", translation=[0, 2, 0], extensions=gltf.light("lamp", "point", 5))
    _animate(gltf, plane, joint, baked)
    _other_scene(gltf, mesh, rich)
    gltf.json["extensions"]["KHR_materials_variants"] = {"variants": [{"name": "rich"}]}
    decorate(gltf)
    # Extras may be anything.
    gltf.json["nodes"][plane]["extras"] = None
    gltf.json["meshes"][mesh]["primitives"][0]["extras"] = [None, [], {}, "", 0, -9007199254740995]
    gltf.json["scenes"][0]["extras"] = "just a word"
    gltf.json["textures"][0]["extras"] = False
    gltf.json["materials"][baked]["extensions"][UNKNOWN]["nested"] = {"extensions": {UNKNOWN: {"extras": None}}}
    gltf.save_gltf(folder / "torture.gltf", ["torture%20images/all%20data.bin", None])
