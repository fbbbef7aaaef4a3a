# A compiler cache, when there is one, makes a second clean build nearly free.
find_program(GLTF_RADIOSITY_CCACHE ccache)
if(GLTF_RADIOSITY_CCACHE AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${GLTF_RADIOSITY_CCACHE})
endif()
