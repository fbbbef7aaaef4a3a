"""8-bit PNG files from a function of the pixel."""

import struct
import zlib


def png(width, height, pixel, channels=3):
    """`pixel(x, y)` answers `channels` numbers in [0,255], row 0 on top.

    The data is stored, not deflated: every version of zlib then gives the same bytes.
    """
    rows = b"".join(
        b"\0" + bytes(c for x in range(width) for c in pixel(x, y)) for y in range(height)
    )
    color_type = {1: 0, 3: 2, 4: 6}[channels]
    header = struct.pack(">IIBBBBB", width, height, 8, color_type, 0, 0, 0)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 0)) + chunk(b"IEND", b"")
