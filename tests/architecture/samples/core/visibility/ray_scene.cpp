// Rays belong here: allowed.
#include "core/visibility/ray_scene.h"

#include <embree3/rtcore.h>
