// What a transport file says about itself, as JSON.
#pragma once

#include <string>

#include "plugin/transport_file.h"

namespace gltf_radiosity {

std::string to_text(const TransportDescription& description);

/// An error if it is no such description: a member that is missing or of another type, an index that leads nowhere.
Result<TransportDescription> read_description(const std::string& text);

}  // namespace gltf_radiosity
