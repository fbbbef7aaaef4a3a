// What light can reach at all.
//
// Real files are full of closed spaces: between the sheets of a wall, below a floor, inside a crate. None of the light
// gets there. In the exchange of light a little leaks in all the same, where a patch lies half inside, and between
// white sheets it is multiplied by up to 1 / (1 - rho). So random walks are followed from everywhere; what none leads
// out of, to the open or within sight of something that emits, is dark:
//
//        \    |  open: reached
//      ___\___|_____________
//     |  _/\__  |           |      o  from here a walk never
//     |_/_____\_|____o______|         leaves the slab
//
// Which light is on does not matter: what light can reach is reached, and everything outside is open, lit or not.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/patches.h"
#include "core/progress.h"
#include "core/visibility/ray_scene.h"

namespace radiosity {

/// 1 for each of the first `patch_count` patches that a walk through it leads out of; all 1 where none is, for then
/// there is no light. Of `patches` the tiling and the patches of tiles are read. REQUIRES: each of them has a tile.
/// Deterministic. Throws `Cancelled`.
std::vector<std::uint8_t> find_reached(const RayScene& rays, const Patches& patches, std::uint32_t patch_count,
                                       const Progress& progress);

}  // namespace radiosity
