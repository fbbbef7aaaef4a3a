// What compression has made superfluous leaves the file.
#pragma once

#include <cstddef>
#include <vector>

#include "plugin/document.h"

namespace gltf_radiosity {

/// Removes the accessors and bufferViews that nothing in the document refers to, and all bytes of its buffers that no
/// bufferView covers. Extensions may refer to accessors and bufferViews in ways that only they know: where there are
/// whole numbers in an extension that this program does not know, the accessors and bufferViews of these numbers stay,
/// and no number changes: the others become stubs without data.
void drop_unused_data(Document& document);

/// Removes those of the images named by `candidates` that no texture refers to, with their bytes, where no unknown
/// extension may refer to them.
void drop_images(Document& document, const std::vector<std::size_t>& candidates);

}  // namespace gltf_radiosity
