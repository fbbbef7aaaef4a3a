// Samples stay where they are when the mesh is cut: each passes to the element that holds it now.
#pragma once

#include <cstdint>
#include <span>

#include "core/mesh/refined_mesh.h"
#include "core/reconstruct/samples.h"

namespace radiosity {

/// `samples` of a mesh that `mesh` was cut from. `origin_of_element` [element_count] says which element of before each
/// one was part of; elements of before keep their numbers for one of their parts. Samples of an element keep their
/// order.
Samples inherit_samples(const Samples& samples, const RefinedMesh& mesh,
                        std::span<const std::uint32_t> origin_of_element);

}  // namespace radiosity
