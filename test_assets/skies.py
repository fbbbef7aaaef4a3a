"""Scenes and images of what stands around a scene."""

from gltf_builder import GltfBuilder
from png import png
from shapes import floor


def image_based_light():
    """A lone floor under EXT_lights_image_based: 2.5 cd/m2 from the upper face of its cube map, 1 from those around."""
    gltf = GltfBuilder()
    gltf.solid("floor", floor(-1, -1, 1, 1, cells=(4, 4)), gltf.material("grey", (0.25, 0.25, 0.25)))
    # RGBD: alpha divides, so 102 of 255 makes white 2.5.
    pixels = {"around": (255, 255, 255, 255), "above": (255, 255, 255, 102), "below": (0, 0, 0, 255)}
    image = {}
    for name, pixel in pixels.items():
        view = gltf.buffer_view(png(8, 8, lambda x, y, pixel=pixel: pixel, channels=4))
        gltf.json.setdefault("images", []).append({"name": name, "bufferView": view, "mimeType": "image/png"})
        image[name] = len(gltf.json["images"]) - 1
    around, above, below = image["around"], image["above"], image["below"]
    light = {
        "name": "overcast",
        "intensity": 1.0,
        "irradianceCoefficients": [[12.06] * 3] + [[0.0] * 3] * 8,
        "specularImageSize": 8,
        "specularImages": [[around, around, above, below, around, around]],
    }
    gltf.use_extension("EXT_lights_image_based")
    gltf.json["extensions"] = {"EXT_lights_image_based": {"lights": [light]}}
    gltf.json["scenes"][0]["extensions"] = {"EXT_lights_image_based": {"light": 0}}
    return gltf


def sunny_hdr():
    """A Radiance HDR image of 64 x 32 texels: 1 cd/m2 above the horizon, 512 in the texel at column 20 of row 7."""
    black, dim, sun = bytes(4), bytes((128, 128, 128, 129)), bytes((128, 128, 128, 138))
    texels = b"".join(
        (sun if (x, y) == (20, 7) else dim if y < 16 else black) for y in range(32) for x in range(64)
    )
    return b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32 +X 64\n" + texels
