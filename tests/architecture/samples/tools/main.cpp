// Tools see the public API only.
#include <tiny_gltf.h>  // forbidden

#include <CLI/CLI.hpp>
#include <cstdio>

#include "core/scene.h"       // forbidden
#include "plugin/document.h"  // forbidden
#include "plugin/gltf_radiosity.h"
#include "tools/command_line.h"
