// Extensions by their names: at the root of a glTF (extensionsUsed and extensionsRequired) and on its objects.
#pragma once

#include <optional>
#include <string>

#include "plugin/document.h"

namespace gltf_radiosity {

/// Adds `extension` to extensionsUsed, unless it is there.
void declare_extension(Json& root, const std::string& extension);

/// Adds `extension` to extensionsUsed and extensionsRequired, unless it is there.
void require_extension(Json& root, const std::string& extension);

/// Takes `extension` off extensionsUsed and extensionsRequired; an array that is left empty goes with it.
void forget_extension(Json& root, const std::string& extension);

/// Takes `extension` off the extensions of an object; the object "extensions" goes with its last member.
void remove_extension(Json& object, const std::string& extension);

/// An extension of a primitive that may name its vertices by their numbers, so that these must stay as they are.
std::optional<std::string> extension_that_names_vertices(const Json& primitive);

}  // namespace gltf_radiosity
