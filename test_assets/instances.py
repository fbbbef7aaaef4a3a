"""One mesh shown many times: EXT_mesh_gpu_instancing, and the same as nodes."""

import math

from gltf_builder import SHORT, UNSIGNED_BYTE, GltfBuilder, as_float32
from shapes import box, floor

_PLACES = [(-1, 0, 0), (0, 0, -0.5), (1, 0.25, 0)]
_TURNS = [(0, 0, 0, 1), (0, as_float32(math.sin(0.4)), 0, as_float32(math.cos(0.4))), (0, 1, 0, 0)]
_SIGNS = [(1.5, 0, -0.8), (1.5, 0, 0.8)]
_SIZES = [(1, 1, 1), (1, 2, 1), (-0.5, 1.5, 0.5)]  # the last one is mirrored


def _stone(gltf, material):
    """A block with a morph target."""
    shape = box((-0.2, 0, -0.2), (0.2, 0.4, 0.2), cells=(2, 2, 2))
    primitive = gltf.primitive(shape, material)
    taller = [(0, 0.1 if p[1] > 0.3 else 0, 0) for p in shape.positions]
    primitive["targets"] = [{"POSITION": gltf.accessor(taller, bounds=True)}]
    return gltf.mesh("stone", primitive, weights=[0.5])


def _animate_weights(gltf, nodes):
    times = gltf.accessor([0, 1], bounds=True, target=None)
    weights = gltf.accessor([0, 1], target=None)
    channels = [{"sampler": 0, "target": {"node": node, "path": "weights"}} for node in nodes]
    gltf.json["animations"] = [{"samplers": [{"input": times, "output": weights}], "channels": channels}]


def instanced(as_nodes=False):
    """Three stones on a floor, turned, stretched and mirrored, under a point light; signs that are unlit and stay."""
    gltf = GltfBuilder()
    gltf.use_extension("KHR_materials_unlit")
    grey = gltf.material("grey", (0.5, 0.5, 0.5))
    sign = gltf.material("sign", (0.9, 0.2, 0.1), extensions={"KHR_materials_unlit": {}})
    signs = gltf.mesh("signs", gltf.primitive(box((0, 0, 0), (0.1, 0.1, 0.1)), sign))
    gltf.solid("floor", floor(-2, -1, 2, 1, cells=(8, 4)), grey)
    stone = _stone(gltf, grey)
    gltf.node("lamp", translation=[0.2, 2, 0.6], extensions=gltf.light("lamp", "point", 5))
    field = gltf.node("stones", translation=[0, 0, 0.1], extras={"quarry": "north"})
    gltf.node("marker", parent=field)
    if as_nodes:
        nodes = [
            gltf.node(f"stones[{k}]", parent=field, mesh=stone, translation=list(place), rotation=list(turn), scale=list(size))
            for k, (place, turn, size) in enumerate(zip(_PLACES, _TURNS, _SIZES))
        ]
        _animate_weights(gltf, nodes)
        for place in _SIGNS:
            gltf.node("sign", mesh=signs, translation=list(place))
        return gltf

    gltf.use_extension("EXT_mesh_gpu_instancing")
    turns = [tuple(round(part * 32767) for part in turn) for turn in _TURNS]
    attributes = {
        "TRANSLATION": gltf.accessor(_PLACES, target=None),
        "ROTATION": gltf.accessor(turns, SHORT, normalized=True, target=None),
        "SCALE": gltf.accessor(_SIZES, target=None),
        "_ID": gltf.accessor([7, 8, 9], UNSIGNED_BYTE, target=None),
    }
    instancing = {"EXT_mesh_gpu_instancing": {"attributes": attributes}}
    gltf.json["nodes"][field].update(mesh=stone, extensions=instancing)
    _animate_weights(gltf, [field])
    places = {"attributes": {"TRANSLATION": gltf.accessor(_SIGNS, target=None)}}
    gltf.node("signs", mesh=signs, extensions={"EXT_mesh_gpu_instancing": places})
    return gltf
