// The item buffer by one ray per cell through Embree, in packets of 4 x 4 neighbouring cells.
#pragma once

#include <memory>

#include "core/visibility/item_buffer.h"
#include "core/visibility/ray_scene.h"

namespace radiosity {

/// `rays` must outlive the maker.
std::unique_ptr<ItemBufferMaker> make_item_buffer_rays(const RayScene& rays);

}  // namespace radiosity
