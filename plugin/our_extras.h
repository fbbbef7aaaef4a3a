// Where this program writes down what it did.
#pragma once

#include "plugin/document.h"

namespace gltf_radiosity {

/// `owner.extras.radiosity`, made if it is missing. Extras that are no object stay beside it, as `extras.original`.
Json& our_extras(Json& owner);

}  // namespace gltf_radiosity
