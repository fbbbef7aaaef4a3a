#!/usr/bin/env python3
"""Writes the test scenes into a folder: make_assets.py OUT_DIR. Standard library only; the same bytes every time.

What each scene shows, and why none is committed: README.md.
"""

import pathlib
import sys

sys.dont_write_bytecode = True  # imported from the source tree, which a build leaves as it is

from cornell_box import cornell_box  # noqa: E402
from features import (  # noqa: E402
    already_coloured,
    extras_everywhere,
    lights_all_kinds,
    mirrored_instance,
    multi_buffer,
    non_manifold,
    occluder,
    points_and_lines,
    skinned_and_morphed,
    strip,
    unit_cube,
    uv_seam,
)
from instances import instanced  # noqa: E402
from materials import panes  # noqa: E402
from rooms import sky_court, two_rooms, white_furnace  # noqa: E402
from skies import image_based_light, sunny_hdr  # noqa: E402
from torture import torture  # noqa: E402
from textured_interior import textured_interior  # noqa: E402


def scenes():
    """Name -> scene, from one surface to whole rooms."""
    return {
        "unit_cube": unit_cube(),
        "occluder": occluder(),
        "uv_seam": uv_seam(),
        "mirrored_instance": mirrored_instance(),
        "already_coloured": already_coloured(),
        "non_manifold": non_manifold(),
        "strip": strip(),
        "points_and_lines": points_and_lines(),
        "skinned_and_morphed": skinned_and_morphed(),
        "instanced": instanced(),
        "instanced_as_nodes": instanced(as_nodes=True),
        "panes": panes(),
        "extras_everywhere": extras_everywhere(),
        "lights_all_kinds": lights_all_kinds(),
        "white_furnace_50": white_furnace(reflectance=0.5, luminance=0.25),
        "white_furnace_90": white_furnace(reflectance=0.9, luminance=0.05),
        "two_rooms": two_rooms(),
        "sky_court": sky_court(),
        "image_based_light": image_based_light(),
        "cornell_box": cornell_box(),
        "cornell_box_1500": cornell_box(vertices=1500),
        "cornell_box_5000": cornell_box(vertices=5000),
        "textured_interior": textured_interior(),
    }


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: make_assets.py OUT_DIR")
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, gltf in scenes().items():
        gltf.save_glb(folder / f"{name}.glb")
    multi_buffer(folder)
    torture(folder)
    (folder / "sunny.hdr").write_bytes(sunny_hdr())


if __name__ == "__main__":
    main()
