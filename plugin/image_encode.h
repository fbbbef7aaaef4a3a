// Pixels -> an encoded image.
#pragma once

#include "plugin/document.h"
#include "plugin/image_decode.h"

namespace gltf_radiosity {

/// An 8-bit RGBA PNG in sRGB.
Bytes encode_png(const Pixels& pixels);

}  // namespace gltf_radiosity
