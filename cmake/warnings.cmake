# Warnings as errors on our own code.
add_library(gltf_radiosity_warnings INTERFACE)
target_compile_options(gltf_radiosity_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wsign-conversion -Wnon-virtual-dtor -Wold-style-cast -Wcast-qual -Werror)
