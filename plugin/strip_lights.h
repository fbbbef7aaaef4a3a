// --strip-lights: the light is in the colours now.
#pragma once

#include "plugin/document.h"

namespace gltf_radiosity {

/// Takes KHR_lights_punctual and EXT_lights_image_based out of the tree, with the images that only they used and the
/// channels of animations that move them. The nodes of the lights stay.
void strip_lights(Document& document);

}  // namespace gltf_radiosity
