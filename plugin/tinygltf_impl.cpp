// tinygltf in a translation unit of our own, under a name of its own, without its image loader and without Draco.
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
