# `cmake --install` gives the command, the library, its public headers and a package for find_package(gltf_radiosity).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/gltf_radiosity)

# A shared library is found by the command that is installed beside it.
set_target_properties(gltf_radiosity PROPERTIES VERSION ${PROJECT_VERSION}
                      SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
if(BUILD_SHARED_LIBS)
  set_target_properties(gltf_radiosity_cli PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
endif()

install(TARGETS gltf_radiosity EXPORT gltf_radiosity_targets INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS gltf_radiosity_cli)
install(FILES ${PROJECT_SOURCE_DIR}/plugin/gltf_radiosity.h ${PROJECT_SOURCE_DIR}/plugin/verify.h ${PROJECT_SOURCE_DIR}/plugin/view.h ${PROJECT_SOURCE_DIR}/plugin/whole_file.h
              ${PROJECT_SOURCE_DIR}/plugin/relight.h ${PROJECT_SOURCE_DIR}/plugin/result.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gltf_radiosity)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

install(EXPORT gltf_radiosity_targets NAMESPACE gltf_radiosity:: DESTINATION ${package_folder})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/gltf_radiosityConfig.cmake.in gltf_radiosityConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(gltf_radiosityConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/gltf_radiosityConfig.cmake ${PROJECT_BINARY_DIR}/gltf_radiosityConfigVersion.cmake
        DESTINATION ${package_folder})
