# Every finding ends the program: a test that only prints a report would pass.
if(GLTF_RADIOSITY_SANITIZE OR GLTF_RADIOSITY_FUZZ)
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
endif()
# What the sanitizers add makes g++ see uninitialised variables where there are none.
if(GLTF_RADIOSITY_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  add_compile_options(-Wno-maybe-uninitialized)
endif()
# Counts which branches an input takes; tests/fuzz links libFuzzer itself.
if(GLTF_RADIOSITY_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
  add_link_options(-fsanitize=fuzzer-no-link)
endif()
# Excludes the others. core/thread_order.h tells it what oneTBB's library does not show.
if(GLTF_RADIOSITY_SANITIZE_THREADS)
  add_compile_options(-fsanitize=thread)
  add_link_options(-fsanitize=thread -Wl,--version-script=${PROJECT_SOURCE_DIR}/cmake/own_symbols.map)
endif()
