// A public header that leaks what it is made of.
#pragma once

#include <tiny_gltf.h>  // forbidden

#include <span>
#include <string_view>

#include "core/scene.h"  // forbidden
#include "result.h"
