// For a library without the page.
#include "plugin/page/page_parts.h"

namespace gltf_radiosity {

std::optional<PageParts> page_parts() { return std::nullopt; }

}  // namespace gltf_radiosity
