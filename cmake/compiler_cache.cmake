# A compiler cache, when there is one, makes a second clean build nearly free; paths relative to the source folder make it
# nearly free in another clone too.
find_program(GLTF_RADIOSITY_CCACHE ccache)
if(GLTF_RADIOSITY_CCACHE AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER
      ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${GLTF_RADIOSITY_CCACHE})
endif()
