// The one door: allowed.
#include "core/mesh/openmesh_bridge.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include "core/mesh/openmesh_join.h"
