"""Reads and writes .glb files: the JSON tree and one buffer."""

import json
import struct

_JSON, _BIN = 0x4E4F534A, 0x004E4942


def read_glb(path):
    """(tree, buffer)."""
    data = path.read_bytes()
    magic, version, _ = struct.unpack_from("<4sII", data)
    if magic != b"glTF" or version != 2:
        raise ValueError(f"{path} is no .glb file of version 2")
    tree, binary, at = None, b"", 12
    while at < len(data):
        size, kind = struct.unpack_from("<II", data, at)
        chunk = data[at + 8 : at + 8 + size]
        if kind == _JSON:
            tree = json.loads(chunk)
        elif kind == _BIN:
            binary = chunk
        at += 8 + size
    if len(tree.get("buffers", [])) > 1:
        raise ValueError(f"{path} has more than one buffer")
    return tree, binary


def write_glb(path, tree, parts):
    """`parts` are byte-like; one after the other they are the buffer."""
    sizes = [memoryview(part).nbytes for part in parts]
    padding = -sum(sizes) % 4
    tree["buffers"] = [{"byteLength": sum(sizes)}]
    text = json.dumps(tree, separators=(",", ":"), ensure_ascii=False).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        total = 12 + 8 + len(text) + 8 + sum(sizes) + padding
        file.write(struct.pack("<4sII", b"glTF", 2, total))
        file.write(struct.pack("<II", len(text), _JSON) + text)
        file.write(struct.pack("<II", sum(sizes) + padding, _BIN))
        for part in parts:
            file.write(part)
        file.write(b"\0" * padding)
