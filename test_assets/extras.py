"""Extras and an unknown extension on every object of a glTF that may carry them."""

UNKNOWN = "EXT_nobody_knows_this"


def _decorate(item, name):
    """What writers lose most easily: null in arrays, empty objects, integers beyond 32 and 53 bits, tiny numbers."""
    item.setdefault("extras", {}).update(
        {"level": name, "list": [1, None, 2], "empty": {}, "none": None, "big": 9007199254740993, "tiny": 1e-300}
    )
    item.setdefault("extensions", {})[UNKNOWN] = {"level": name, "index": 4294967296, "words": ["grün", "", "\u2764"]}


def _nested(json):
    """(object, its name) of everything below the top-level arrays."""
    for mesh in json["meshes"]:
        for primitive in mesh["primitives"]:
            yield primitive, "primitive"
    for material in json["materials"]:
        yield material["pbrMetallicRoughness"], "pbrMetallicRoughness"
        if "baseColorTexture" in material["pbrMetallicRoughness"]:
            yield material["pbrMetallicRoughness"]["baseColorTexture"], "baseColorTexture"
    for camera in json["cameras"]:
        yield camera[camera["type"]], camera["type"]
    for animation in json["animations"]:
        for sampler in animation["samplers"]:
            yield sampler, "animation.sampler"
        for channel in animation["channels"]:
            yield channel, "animation.channel"
            yield channel["target"], "animation.channel.target"


def decorate(gltf):
    gltf.use_extension(UNKNOWN)
    json = gltf.json
    json["buffers"] = [{} for _ in gltf.buffers]
    for array in ("accessors", "animations", "buffers", "bufferViews", "cameras", "images", "materials", "meshes",
                  "nodes", "samplers", "scenes", "skins", "textures"):
        for item in json.get(array, []):
            _decorate(item, array)
    for light in json["extensions"]["KHR_lights_punctual"]["lights"]:
        _decorate(light, "light")
    for item, name in _nested(json):
        _decorate(item, name)
    _decorate(json["asset"], "asset")
    _decorate(json, "root")
