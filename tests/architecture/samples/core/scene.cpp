// Everything core must not do.
#include "core/scene.h"

#include <draco/compression/decode.h>  // forbidden
#include <embree3/rtcore.h>            // forbidden
#include <tiny_gltf.h>                 // forbidden

#include <CLI/CLI.hpp>                                 // forbidden
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>  // forbidden
#include <cstdio>                                      // forbidden
#include <fstream>                                     // forbidden
#include <iostream>                                    // forbidden
#include <nlohmann/json.hpp>                           // forbidden
#include <vector>

#include "core/mesh/openmesh_join.h"  // forbidden
#include "plugin/document.h"          // forbidden
#include "scene.h"                    // forbidden
#include "tools/command_line.h"       // forbidden

// A comment may say std::cout << and #include <iostream>.
void print_area(float radius) {
  std::cout << 3.14159F * radius * radius;       // forbidden
  std::printf("%f", std::numbers::pi * radius);  // forbidden
  exit(1);                                       // forbidden
  std::atomic<int> count{0};                     // forbidden
  std::atomic_ref(radius).store(1.0F);
}
