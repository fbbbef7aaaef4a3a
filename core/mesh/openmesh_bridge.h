// Triangles <-> OpenMesh: the only door to OpenMesh.
