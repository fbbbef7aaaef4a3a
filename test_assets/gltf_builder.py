"""Builds a small glTF in memory and writes it as .glb or as .gltf with files beside it."""

import base64
import json
import math
import struct

BYTE, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT, UNSIGNED_INT, FLOAT = 5120, 5121, 5122, 5123, 5125, 5126
POINTS, LINES, TRIANGLES, TRIANGLE_STRIP, TRIANGLE_FAN = 0, 1, 4, 5, 6
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
NEAREST, LINEAR = 9728, 9729
REPEAT, MIRRORED_REPEAT, CLAMP_TO_EDGE = 10497, 33648, 33071

_FORMATS = {BYTE: "b", UNSIGNED_BYTE: "B", SHORT: "h", UNSIGNED_SHORT: "H", UNSIGNED_INT: "I", FLOAT: "f"}
_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}


def as_float32(value):
    """The number that a 32-bit float holds: min and max must agree with the data to the bit."""
    return struct.unpack("<f", struct.pack("<f", value))[0]


class GltfBuilder:
    """`json` may be changed freely before it is written; methods return the index of what they add."""

    def __init__(self):
        self.json = {
            "asset": {"version": "2.0", "generator": "gltf-radiosity test_assets"},
            "scene": 0,
            "scenes": [{"nodes": []}],
            "nodes": [],
        }
        self.buffers = [bytearray()]

    def _add(self, array, item):
        self.json.setdefault(array, []).append(item)
        return len(self.json[array]) - 1

    def use_extension(self, name, required=False):
        for key in ["extensionsUsed"] + (["extensionsRequired"] if required else []):
            if name not in self.json.setdefault(key, []):
                self.json[key].append(name)

    def buffer_view(self, data, target=None, stride=None, buffer=0):
        """Appends `data` to a buffer, aligned to 4 bytes."""
        while len(self.buffers) <= buffer:
            self.buffers.append(bytearray())
        into = self.buffers[buffer]
        into.extend(b"\0" * (-len(into) % 4))
        view = {"buffer": buffer, "byteOffset": len(into), "byteLength": len(data)}
        if stride:
            view["byteStride"] = stride
        if target:
            view["target"] = target
        into.extend(data)
        return self._add("bufferViews", view)

    def accessor(self, rows, component=FLOAT, normalized=False, bounds=False, target=ARRAY_BUFFER, buffer=0):
        """`rows` are numbers or tuples of numbers. Vertex attributes are padded so that each starts at 4 bytes."""
        rows = [row if isinstance(row, (tuple, list)) else (row,) for row in rows]
        width = len(rows[0])
        row_format = "<%d%s" % (width, _FORMATS[component])
        size = struct.calcsize(row_format)
        padding = b"\0" * (-size % 4) if target == ARRAY_BUFFER else b""
        data = b"".join(struct.pack(row_format, *row) + padding for row in rows)
        stride = size + len(padding) if padding else None
        accessor = {
            "bufferView": self.buffer_view(data, target, stride, buffer),
            "componentType": component,
            "count": len(rows),
            "type": _TYPES[width],
        }
        if normalized:
            accessor["normalized"] = True
        if bounds:
            exact = [[as_float32(x) if component == FLOAT else x for x in row] for row in rows]
            accessor["min"] = [min(column) for column in zip(*exact)]
            accessor["max"] = [max(column) for column in zip(*exact)]
        return self._add("accessors", accessor)

    @staticmethod
    def data_uri(kind, data):
        return f"data:{kind};base64,{base64.b64encode(bytes(data)).decode()}"

    def sparse_accessor(self, count, kind, sparse):
        """Floats, zero but for those that `sparse` replaces by zeros too."""
        bounds = [0.0] * {"SCALAR": 1, "VEC3": 3}[kind]
        accessor = {"componentType": FLOAT, "count": count, "type": kind, "min": bounds, "max": bounds, "sparse": sparse}
        return self._add("accessors", accessor)

    def material(self, name, color=(1, 1, 1), emission=None, alpha=1.0, **more):
        """`emission` is a luminance in cd/m2; above 1 it needs KHR_materials_emissive_strength."""
        material = {
            "name": name,
            "pbrMetallicRoughness": {
                "baseColorFactor": [*color, alpha],
                "metallicFactor": 0,
                "roughnessFactor": 1,
            },
        }
        if emission:
            strength = max(1.0, *emission)
            material["emissiveFactor"] = [band / strength for band in emission]
            if strength > 1:
                self.use_extension("KHR_materials_emissive_strength")
                material["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}
        material.update(more)
        return self._add("materials", material)

    def texture(self, png, wrap=(REPEAT, REPEAT), uri=None, name=None, filters=(LINEAR, LINEAR)):
        """`png` is stored in the buffer, or expected beside the file if there is a `uri`."""
        image = {"uri": uri} if uri else {"bufferView": self.buffer_view(png), "mimeType": "image/png"}
        if name:
            image["name"] = name
        sampler = {"magFilter": filters[0], "minFilter": filters[1], "wrapS": wrap[0], "wrapT": wrap[1]}
        source = self._add("images", image)
        return self._add("textures", {"source": source, "sampler": self._add("samplers", sampler)})

    def primitive(self, shape, material=None, mode=TRIANGLES, indexed=True, uvs=False, buffer=0):
        """A primitive from shapes.Shape; `uvs` writes TEXCOORD_0 too."""
        attributes = {"POSITION": self.accessor(shape.positions, bounds=True, buffer=buffer)}
        if shape.normals:
            attributes["NORMAL"] = self.accessor(shape.normals, buffer=buffer)
        if uvs:
            attributes["TEXCOORD_0"] = self.accessor(shape.uvs, buffer=buffer)
        primitive = {"attributes": attributes}
        if indexed:
            component = UNSIGNED_SHORT if len(shape.positions) < 65535 else UNSIGNED_INT
            primitive["indices"] = self.accessor(
                shape.indices, component, target=ELEMENT_ARRAY_BUFFER, buffer=buffer
            )
        if material is not None:
            primitive["material"] = material
        if mode != TRIANGLES:
            primitive["mode"] = mode
        return primitive

    def mesh(self, name, *primitives, **more):
        return self._add("meshes", {"name": name, "primitives": list(primitives), **more})

    def node(self, name, parent=None, **more):
        """A root of the first scene unless it has a `parent`."""
        index = self._add("nodes", {"name": name, **more})
        siblings = self.json["scenes"][0]["nodes"]
        if parent is not None:
            siblings = self.json["nodes"][parent].setdefault("children", [])
        siblings.append(index)
        return index

    def solid(self, name, shape, material, uvs=False, **more):
        """A node with a mesh of one primitive."""
        return self.node(name, mesh=self.mesh(name, self.primitive(shape, material, uvs=uvs)), **more)

    def light(self, name, kind, intensity, color=(1, 1, 1), **more):
        """Answers the extension that a node needs to carry the light."""
        self.use_extension("KHR_lights_punctual")
        lights = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append({"name": name, "type": kind, "intensity": intensity, "color": list(color), **more})
        return {"KHR_lights_punctual": {"light": len(lights) - 1}}

    def camera(self, name, eye, yfov_degrees, turn_degrees=0.0):
        """A perspective camera at `eye`, turned about +Y; at 0 it looks along -Z."""
        perspective = {"yfov": math.radians(yfov_degrees), "znear": 0.01, "zfar": 100.0, "aspectRatio": 1.0}
        camera = self._add("cameras", {"name": name, "type": "perspective", "perspective": perspective})
        half = math.radians(turn_degrees) / 2
        return self.node(
            name, camera=camera, translation=list(eye), rotation=[0, as_float32(math.sin(half)), 0, as_float32(math.cos(half))]
        )

    def save_glb(self, path):
        """One file. REQUIRES: a single buffer."""
        assert len(self.buffers) == 1
        binary = bytes(self.buffers[0]) + b"\0" * (-len(self.buffers[0]) % 4)
        if binary:
            self.json["buffers"] = [{"byteLength": len(self.buffers[0]), **self.json.get("buffers", [{}])[0]}]
        text = json.dumps(self.json, separators=(",", ":"), ensure_ascii=False).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
        if binary:
            chunks += struct.pack("<II", len(binary), 0x004E4942) + binary
        path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)

    def save_gltf(self, path, buffer_uris):
        """A .gltf and one file for each buffer. The uris are written as given and must be percent-encoded; None is a data URI."""
        from urllib.parse import unquote

        described = self.json.get("buffers", [{}] * len(self.buffers))
        self.json["buffers"] = [
            {"uri": uri or self.data_uri("application/octet-stream", data), "byteLength": len(data), **more}
            for uri, data, more in zip(buffer_uris, self.buffers, described, strict=True)
        ]
        for uri, data in zip(buffer_uris, self.buffers):
            if uri:
                (path.parent / unquote(uri)).write_bytes(bytes(data))
        path.write_text(json.dumps(self.json, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
