# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# What `cmake --install` puts where, besides the programs: public headers, static libraries, the CMake
# package `palmar`, so that another project says
#
#     find_package(palmar REQUIRED)
#     target_link_libraries(my_program PRIVATE palmar::palmar)
include(CMakePackageConfigHelpers)

# All of it: the tasks of the layer workflow and what they stand on.
add_library(palmar_umbrella INTERFACE)
add_library(palmar::palmar ALIAS palmar_umbrella)
target_link_libraries(palmar_umbrella INTERFACE palmar::workflow palmar::workflow_redesign)
palmar_export(palmar_umbrella palmar)

install(CODE "
  include(${CMAKE_SOURCE_DIR}/cmake/PalmarPublicHeaders.cmake)
  palmar_install_public_headers(${CMAKE_SOURCE_DIR}/src \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}\")"
  COMPONENT development)

set(palmar_package ${CMAKE_INSTALL_LIBDIR}/cmake/palmar)
install(EXPORT palmar NAMESPACE palmar:: FILE palmarTargets.cmake DESTINATION ${palmar_package} COMPONENT development)
configure_package_config_file(${CMAKE_SOURCE_DIR}/cmake/palmarConfig.cmake.in ${CMAKE_BINARY_DIR}/palmarConfig.cmake
                              INSTALL_DESTINATION ${palmar_package})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/palmarConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/palmarConfig.cmake ${CMAKE_BINARY_DIR}/palmarConfigVersion.cmake
        DESTINATION ${palmar_package} COMPONENT development)
