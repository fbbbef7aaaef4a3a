// What plugin may and may not include.
#include "plugin/document.h"

#include <embree3/rtcore.h>  // forbidden
#include <tiny_gltf.h>

#include <CLI/CLI.hpp>                                 // forbidden
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>  // forbidden
#include <cstdio>
#include <iostream>  // forbidden
#include <nlohmann/json.hpp>

#include "core/scene.h"
#include "tools/command_line.h"  // forbidden
