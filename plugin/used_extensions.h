// The names of extensions at the root of a glTF: extensionsUsed and extensionsRequired.
#pragma once

#include <string>

#include "plugin/document.h"

namespace gltf_radiosity {

/// Adds `extension` to extensionsUsed, unless it is there.
void declare_extension(Json& root, const std::string& extension);

/// Takes `extension` off extensionsUsed and extensionsRequired; an array that is left empty goes with it.
void forget_extension(Json& root, const std::string& extension);

/// Takes `extension` off the extensions of an object; the object "extensions" goes with its last member.
void remove_extension(Json& object, const std::string& extension);

}  // namespace gltf_radiosity
