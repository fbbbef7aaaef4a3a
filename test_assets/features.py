"""One feature of glTF or of geometry each, in as few triangles as it takes."""

import math

from extras import decorate
from gltf_builder import LINES, POINTS, TRIANGLE_FAN, TRIANGLE_STRIP, UNSIGNED_BYTE, GltfBuilder, as_float32
from png import png
from shapes import Shape, box, cylinder, floor, quad

_HALF = as_float32(math.sqrt(0.5))
LOOKING_DOWN = [-_HALF, 0, 0, _HALF]  # turns -Z, along which lights shine, to -Y


def unit_cube():
    """A cube of 1 m, and nothing that shines."""
    gltf = GltfBuilder()
    gltf.solid("cube", box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)), gltf.material("grey", (0.5, 0.5, 0.5)))
    return gltf


def occluder():
    """A plate between a point light and the floor: a shadow with a sharp edge, 2 m wide."""
    gltf = GltfBuilder()
    grey = gltf.material("grey", (0.5, 0.5, 0.5))
    gltf.solid("floor", floor(-2, -2, 2, 2, cells=(32, 32)), grey)
    gltf.solid("plate", box((-0.5, 1.5, -0.5), (0.5, 1.52, 0.5)), gltf.material("black", (0, 0, 0)))
    gltf.node("lamp", translation=[0, 3, 0], extensions=gltf.light("lamp", "point", 30))
    return gltf


def uv_seam():
    """A tube with a seam in its uvs, where two vertices share position and normal; lit full on the seam."""
    gltf = GltfBuilder()
    texture = gltf.texture(png(32, 8, lambda x, y: (60 + 6 * x, 200, 250 - 6 * x)), name="ramp")
    material = gltf.material("ramp")
    gltf.json["materials"][material]["pbrMetallicRoughness"]["baseColorTexture"] = {"index": texture}
    gltf.solid("tube", cylinder(0.5, 1.0, 24, 4), material, uvs=True)
    gltf.solid("floor", floor(-2, -2, 2, 2, cells=(8, 8)), gltf.material("grey", (0.5, 0.5, 0.5)))
    gltf.node("lamp", translation=[0, 1.5, 2], extensions=gltf.light("lamp", "point", 8))
    return gltf


def mirrored_instance():
    """One mesh, two nodes, the second with a negative scale; everything is symmetrical about x = 0."""
    gltf = GltfBuilder()
    grey = gltf.material("grey", (0.6, 0.6, 0.6))
    hook = box((0, 0, -0.2), (1, 0.2, 0.2), cells=(5, 1, 2)).add(box((0, 0.2, -0.2), (0.2, 0.8, 0.2), cells=(1, 3, 2)))
    mesh = gltf.mesh("hook", gltf.primitive(hook, grey))
    gltf.node("right", mesh=mesh, translation=[0.5, 0.25, 0])
    gltf.node("left", mesh=mesh, translation=[-0.5, 0.25, 0], scale=[-1, 1, 1])
    gltf.solid("floor", floor(-2, -1, 2, 1, cells=(16, 8)), grey)
    gltf.node("lamp", translation=[0, 1.5, 0.3], extensions=gltf.light("lamp", "point", 3))
    return gltf


def already_coloured():
    """A lone plane with COLOR_0 as normalized bytes under a light of pi lux: it shows its own colours."""
    gltf = GltfBuilder()
    shape = floor(-1, -1, 1, 1, cells=(4, 4))
    primitive = gltf.primitive(shape, gltf.material("white"))
    colors = [(255, 128, 0, 255) if x < 0 else (51, 102, 204, 255) for x, _, _ in shape.positions]
    primitive["attributes"]["COLOR_0"] = gltf.accessor(colors, UNSIGNED_BYTE, normalized=True)
    gltf.node("plane", mesh=gltf.mesh("plane", primitive))
    gltf.node("sun", rotation=LOOKING_DOWN, extensions=gltf.light("sun", "directional", math.pi))
    return gltf


def non_manifold():
    """Three triangles at an edge, a duplicate, a flipped duplicate and two degenerate ones. None may be lost."""
    gltf = GltfBuilder()
    shape = Shape()
    shape.positions = [(0, 0, 0), (1, 0, 0), (0.5, 0, 1), (0.5, 1, 0.5), (0.5, 0, -1), (2, 0, 0)]
    shape.indices = [0, 2, 1, 0, 1, 3, 0, 1, 4]  # three at the edge 0 1
    shape.indices += [0, 2, 1]  # once more
    shape.indices += [0, 1, 2]  # and turned over
    shape.indices += [0, 1, 5, 3, 3, 4]  # without area: in one line, and with a corner twice
    gltf.solid("fins", shape, gltf.material("grey", (0.5, 0.5, 0.5), doubleSided=True))
    gltf.node("lamp", translation=[0.5, 3, 0.2], extensions=gltf.light("lamp", "point", 10))
    return gltf


def strip():
    """A strip with joints of degenerate triangles, and a fan without indices."""
    gltf = GltfBuilder()
    grey = gltf.material("grey", (0.5, 0.5, 0.5))
    rows, columns, shape = 4, 6, Shape()
    for j in range(rows + 1):
        for i in range(columns + 1):
            shape.positions.append((i / 2 - 1.5, 0.0, j / 2 - 1.0))
            shape.normals.append((0.0, 1.0, 0.0))
    for j in range(rows):
        row = [k * (columns + 1) + i for i in range(columns + 1) for k in (j, j + 1)]
        shape.indices += ([shape.indices[-1], row[0]] if j else []) + row
    gltf.node("strip", mesh=gltf.mesh("strip", gltf.primitive(shape, grey, mode=TRIANGLE_STRIP)))
    fan = Shape()
    around = [(0.5 * math.sin(a), 0.5, 0.5 * math.cos(a)) for a in (2 * math.pi * k / 12 for k in range(13))]
    fan.positions = [(0.0, 0.5, 0.0)] + around
    fan.normals = [(0.0, 1.0, 0.0)] * len(fan.positions)
    gltf.node("fan", mesh=gltf.mesh("fan", gltf.primitive(fan, grey, mode=TRIANGLE_FAN, indexed=False)))
    gltf.node("lamp", translation=[0, 2, 0], extensions=gltf.light("lamp", "point", 5))
    return gltf


def points_and_lines():
    """Triangles beside points and lines, which carry no light and stay as they are."""
    gltf = GltfBuilder()
    grey = gltf.material("grey", (0.5, 0.5, 0.5))
    dots = Shape()
    dots.positions = [(x / 4, 0.5, 0.0) for x in range(-4, 5)]
    dots.indices = list(range(8))
    triangles = gltf.primitive(floor(-1, -1, 1, 1, cells=(2, 2)), grey)
    points = gltf.primitive(dots, grey, mode=POINTS, indexed=False)
    lines = gltf.primitive(dots, grey, mode=LINES)
    gltf.node("all", mesh=gltf.mesh("all", points, triangles, lines))
    gltf.node("sun", rotation=LOOKING_DOWN, extensions=gltf.light("sun", "directional", 2))
    return gltf


def skinned_strip(gltf, material):
    """A strip that bends at its middle; answers its upper joint."""
    shape = quad([(-0.1, 0, 0), (0.1, 0, 0), (0.1, 1, 0), (-0.1, 1, 0)], cells=(1, 8))
    primitive = gltf.primitive(shape, material)
    primitive["attributes"]["JOINTS_0"] = gltf.accessor([(0, int(p[1] > 0), 0, 0) for p in shape.positions], UNSIGNED_BYTE)
    primitive["attributes"]["WEIGHTS_0"] = gltf.accessor([(1 - p[1], p[1], 0, 0) for p in shape.positions])
    skinned = gltf.node("skinned", mesh=gltf.mesh("skinned", primitive))
    lower = gltf.node("lower_joint")
    upper = gltf.node("upper_joint", parent=lower, translation=[0, 0.5, 0])
    identity = (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)
    raised = identity[:13] + (-0.5,) + identity[14:]
    inverse = gltf.accessor([identity, raised], target=None)
    gltf.json["skins"] = [{"joints": [lower, upper], "inverseBindMatrices": inverse, "skeleton": lower}]
    gltf.json["nodes"][skinned]["skin"] = 0
    return upper


def skinned_and_morphed():
    """A skinned strip and a plane with two morph targets, both animated: the rest pose is baked."""
    gltf = GltfBuilder()
    grey = gltf.material("grey", (0.6, 0.6, 0.6), doubleSided=True)
    joint = skinned_strip(gltf, grey)
    shape = floor(-1, -1, 1, 1, cells=(4, 4))
    primitive = gltf.primitive(shape, grey)
    for direction in ((0, 0.3, 0), (0.2, 0, 0)):
        moves = [tuple(d * (1 - p[0] ** 2) for d in direction) for p in shape.positions]
        target = {"POSITION": gltf.accessor(moves, bounds=True), "NORMAL": gltf.accessor([(0, 0, 0)] * len(moves))}
        primitive.setdefault("targets", []).append(target)
    morphed = gltf.node("morphed", mesh=gltf.mesh("morphed", primitive, weights=[0.0, 0.0]))
    times = gltf.accessor([0, 1], bounds=True, target=None)
    turns = gltf.accessor([(0, 0, 0, 1), (0, 0, _HALF, _HALF)], target=None)
    weights = gltf.accessor([0, 0, 1, 0.5], target=None)
    gltf.json["animations"] = [
        {
            "name": "sway",
            "samplers": [{"input": times, "output": turns}, {"input": times, "output": weights}],
            "channels": [
                {"sampler": 0, "target": {"node": joint, "path": "rotation"}},
                {"sampler": 1, "target": {"node": morphed, "path": "weights"}},
            ],
        }
    ]
    gltf.node("lamp", translation=[0, 2, 1], extensions=gltf.light("lamp", "point", 8))
    return gltf


def lights_all_kinds():
    """A floor lit by a point, a spot (below nodes that turn and scale) and a directional light. Closed forms hold."""
    gltf = GltfBuilder()
    gltf.solid("floor", floor(-4, -2, 4, 2, cells=(64, 32)), gltf.material("grey", (0.5, 0.5, 0.5)))
    gltf.node("point", translation=[-2, 1, 0], extensions=gltf.light("point", "point", 1.0, (1, 0.5, 0.25), range=4))
    arm = gltf.node("arm", translation=[2, 0.5, 0], scale=[2, 2, 2])
    cone = {"innerConeAngle": 0.3, "outerConeAngle": 0.6}
    spot = gltf.light("spot", "spot", 1.5, (0.25, 0.5, 1), spot=cone)
    gltf.node("spot", parent=arm, translation=[0, 0.25, 0], rotation=LOOKING_DOWN, extensions=spot)
    gltf.node("sun", rotation=LOOKING_DOWN, extensions=gltf.light("sun", "directional", 0.2))
    return gltf


def extras_everywhere():
    """Extras and an extension nobody knows at every level, an unlit object, a second scene: all must survive."""
    gltf = GltfBuilder()
    gltf.use_extension("KHR_materials_unlit")
    texture = gltf.texture(png(4, 4, lambda x, y: (200, 40 * x, 40 * y)), name="patch")
    material = gltf.material("coloured", emissiveFactor=[0, 0.1, 0])
    gltf.json["materials"][material]["pbrMetallicRoughness"]["baseColorTexture"] = {"index": texture}
    sign = gltf.material("sign", (0.9, 0.2, 0.1), extensions={"KHR_materials_unlit": {}})
    plane = gltf.solid("plane", floor(-1, -1, 1, 1, cells=(2, 2)), material, uvs=True)
    gltf.solid("sign", quad([(0, 0.2, 0), (0.5, 0.2, 0), (0.5, 0.7, 0), (0, 0.7, 0)]), sign)
    gltf.camera("camera", (0, 1, 3), 45)
    gltf.node("lamp", translation=[0, 2, 0], extensions=gltf.light("lamp", "point", 5, extras={"watt": 40}))
    gltf.json["nodes"].append({})  # in no scene
    gltf.json["scenes"].append({"name": "other", "nodes": [len(gltf.json["nodes"]) - 1]})
    times = gltf.accessor([0, 2], bounds=True, target=None)
    moves = gltf.accessor([(0, 0, 0), (0, 0.5, 0)], target=None)
    target = {"node": plane, "path": "translation"}
    animation = {"samplers": [{"input": times, "output": moves}], "channels": [{"sampler": 0, "target": target}]}
    gltf.json["animations"] = [animation]
    decorate(gltf)
    return gltf


def multi_buffer(folder):
    """A .gltf with two buffers and an image in files, with names that must be percent-encoded."""
    gltf = GltfBuilder()
    (folder / "textures").mkdir(exist_ok=True)
    image = png(16, 16, lambda x, y: (180, 90, 60) if y % 8 and (x + 4 * (y // 8 % 2)) % 8 else (200, 200, 190))
    (folder / "textures" / "brick wall.png").write_bytes(image)
    bricks = gltf.material("bricks")
    texture = gltf.texture(None, uri="textures/brick%20wall.png", name="bricks")
    gltf.json["materials"][bricks]["pbrMetallicRoughness"]["baseColorTexture"] = {"index": texture}
    wall = gltf.primitive(quad([(-1, 0, -1), (1, 0, -1), (1, 1, -1), (-1, 1, -1)], (4, 2), (2, 1)), bricks, uvs=True)
    ground = gltf.primitive(floor(-1, -1, 1, 1, cells=(4, 4)), gltf.material("grey", (0.5, 0.5, 0.5)), buffer=1)
    gltf.node("yard", mesh=gltf.mesh("yard", wall, ground))
    gltf.node("lamp", translation=[0, 1, 0.5], extensions=gltf.light("lamp", "point", 2))
    gltf.save_gltf(folder / "multi_buffer.gltf", ["wall%20geometry.bin", "ground.bin"])
