# Every finding ends the program: a test that only prints a report would pass.
if(GLTF_RADIOSITY_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  # What the sanitizers add makes g++ see uninitialised variables where there are none.
  add_compile_options(-Wno-maybe-uninitialized)
  add_link_options(-fsanitize=address,undefined)
endif()
