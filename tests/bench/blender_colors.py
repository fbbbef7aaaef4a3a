"""The way into Blender and out again: names that survive its importer, and its light as COLOR_0 of the same file."""

import array
import copy

from glb import read_glb, write_glb

_INDEX_TYPES = {5121: "B", 5123: "H", 5125: "I"}
_UNLIT = "KHR_materials_unlit"


def write_for_blender(path, named):
    """Copies the .glb at `path` to `named`, with unique names for nodes and a mesh of its own for each node."""
    tree, binary = read_glb(path)
    _refuse_what_would_not_compare(tree)
    tree["scenes"] = [tree["scenes"][tree.get("scene", 0)]]
    tree["scene"] = 0
    meshes = tree["meshes"]
    tree["meshes"] = []
    for index, node in enumerate(tree["nodes"]):
        node["name"] = f"n{index}"
        if "mesh" in node:
            tree["meshes"].append(copy.deepcopy(meshes[node["mesh"]]))
            node["mesh"] = len(tree["meshes"]) - 1
    write_glb(named, tree, [binary])


def _refuse_what_would_not_compare(tree):
    extensions = tree.get("extensionsUsed", [])
    if "KHR_lights_punctual" in extensions:
        raise ValueError("punctual lights: Blender reads them in units of its own")
    if "KHR_draco_mesh_compression" in extensions:
        raise ValueError("Draco: decompress the file first")
    if any("COLOR_0" in primitive["attributes"] for mesh in tree["meshes"] for primitive in mesh["primitives"]):
        raise ValueError("the file has vertex colours already")


def write_colored(named, folder, exposure, out):
    """Puts FOLDER/NODE.f32 (H/pi at each used vertex) into the file that write_for_blender made.

    The same rule as for every bake of this project: COLOR_0 = exposure x (reflectance x H/pi + luminance), where a base
    colour texture stays a texture, clamped to [0, 1] because glTF wants that.
    """
    tree, binary = read_glb(named)
    views, accessors = tree["bufferViews"], tree["accessors"]
    parts = [binary, b"\0" * (-len(binary) % 4)]
    size = sum(map(len, parts))
    for node in tree["nodes"]:
        light_path = folder / f"{node['name']}.f32"
        if "mesh" not in node or not light_path.exists():
            continue
        light = array.array("f", light_path.read_bytes())
        first = 0
        for primitive in tree["meshes"][node["mesh"]]["primitives"]:
            count = accessors[primitive["attributes"]["POSITION"]]["count"]
            used = _used_vertices(tree, binary, primitive, count)
            surface = _surface(tree, primitive)
            colors = _colors(light, first, used, count, exposure, surface)
            first += len(used)
            views.append({"buffer": 0, "byteOffset": size, "byteLength": 16 * count, "target": 34962})
            accessors.append({"bufferView": len(views) - 1, "componentType": 5126, "count": count, "type": "VEC4"})
            primitive["attributes"]["COLOR_0"] = len(accessors) - 1
            parts.append(colors)
            size += 16 * count
        if 4 * first != len(light):
            raise ValueError(f"{node['name']}: the file has {first} used vertices, Blender {len(light) // 4}")
    _make_unlit(tree)
    write_glb(out, tree, parts)


def vertex_count(path):
    tree, _ = read_glb(path)
    positions = {primitive["attributes"]["POSITION"] for mesh in tree["meshes"] for primitive in mesh["primitives"]}
    return sum(tree["accessors"][index]["count"] for index in positions)


def _used_vertices(tree, binary, primitive, count):
    """Ascending, as the importer numbers them."""
    if "indices" not in primitive:
        return range(count)
    accessor = tree["accessors"][primitive["indices"]]
    view = tree["bufferViews"][accessor["bufferView"]]
    indices = array.array(_INDEX_TYPES[accessor["componentType"]])
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    indices.frombytes(binary[start : start + accessor["count"] * indices.itemsize])
    return sorted(set(indices))


def _surface(tree, primitive):
    """(reflectance or texture's factor, luminance to add)."""
    material = tree["materials"][primitive["material"]] if "material" in primitive else {}
    pbr = material.get("pbrMetallicRoughness", {})
    factor = pbr.get("baseColorFactor", [1, 1, 1, 1])[:3]
    if "baseColorTexture" in pbr:
        return factor, [0, 0, 0]
    extension = material.get("extensions", {}).get("KHR_materials_emissive_strength", {})
    strength = extension.get("emissiveStrength", 1)
    return factor, [strength * band for band in material.get("emissiveFactor", [0, 0, 0])]


def _colors(light, first, used, count, exposure, surface):
    colors = array.array("f", [0, 0, 0, 1]) * count
    factors, luminances = surface
    for rank, vertex in enumerate(used, first):
        for band in range(3):
            color = exposure * (factors[band] * light[4 * rank + band] + luminances[band])
            colors[4 * vertex + band] = min(1.0, color)
    return colors


def _make_unlit(tree):
    materials = tree.setdefault("materials", [])
    for index, material in enumerate(materials):
        pbr = material.get("pbrMetallicRoughness", {})
        alpha = pbr.get("baseColorFactor", [1, 1, 1, 1])[3]
        unlit = {"baseColorFactor": [1, 1, 1, alpha]}
        if "baseColorTexture" in pbr:
            unlit["baseColorTexture"] = pbr["baseColorTexture"]
        kept = {key: material[key] for key in ("name", "alphaMode", "alphaCutoff", "doubleSided") if key in material}
        materials[index] = {**kept, "pbrMetallicRoughness": unlit, "extensions": {_UNLIT: {}}}
    for mesh in tree["meshes"]:
        for primitive in mesh["primitives"]:
            if "material" not in primitive:
                materials.append({"extensions": {_UNLIT: {}}})
                primitive["material"] = len(materials) - 1
    tree.setdefault("extensionsUsed", [])
    tree["extensionsUsed"] = [name for name in tree["extensionsUsed"] if name != "KHR_materials_emissive_strength"]
    if _UNLIT not in tree["extensionsUsed"]:
        tree["extensionsUsed"].append(_UNLIT)
