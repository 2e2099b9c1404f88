# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# What `cpack` makes in a build directory: palmar_VERSION_amd64.deb (programs, template hand, manual
# pages, completion, desktop entry and file types) and palmar-dev (libraries, headers, CMake package).
# `--target manual` writes manual pages and completion before; scripts/package.sh does it all.
find_program(PALMAR_NODE node REQUIRED)
set(manual ${CMAKE_BINARY_DIR}/manual)
add_custom_target(manual
  COMMAND ${PALMAR_NODE} ${CMAKE_SOURCE_DIR}/scripts/manual.mjs $<TARGET_FILE:palmar> ${manual}
  DEPENDS palmar palmar-hands palmar-redesign palmar-serve
  COMMENT "Writing manual pages and completion"
  VERBATIM)

set(doc ${CMAKE_INSTALL_DATAROOTDIR}/doc/palmar)
install(DIRECTORY ${manual}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR} OPTIONAL COMPONENT palmar)
install(FILES ${manual}/completions/palmar.bash DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/bash-completion/completions
        RENAME palmar OPTIONAL COMPONENT palmar)
install(FILES ${manual}/completions/_palmar DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/zsh/vendor-completions
        OPTIONAL COMPONENT palmar)
install(FILES ${manual}/completions/palmar.fish DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/fish/vendor_completions.d
        OPTIONAL COMPONENT palmar)
install(FILES ${CMAKE_SOURCE_DIR}/packaging/palmar.desktop DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/applications
        COMPONENT palmar)
install(FILES ${CMAKE_SOURCE_DIR}/packaging/palmar.xml DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/mime/packages
        COMPONENT palmar)
install(FILES ${CMAKE_SOURCE_DIR}/packaging/copyright ${CMAKE_SOURCE_DIR}/CHANGELOG.md
              ${CMAKE_SOURCE_DIR}/docs/developing/third-party.md DESTINATION ${doc} COMPONENT palmar)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/examples DESTINATION ${doc} COMPONENT palmar)
install(FILES ${CMAKE_SOURCE_DIR}/packaging/copyright
        DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/palmar-dev COMPONENT development)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME palmar)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "The Palmar authors <authors@palmar.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL palmar development)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PALMAR_PACKAGE_NAME palmar)
set(CPACK_DEBIAN_PALMAR_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PALMAR_PACKAGE_RECOMMENDS "xdg-utils")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME palmar-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "palmar (= ${PROJECT_VERSION}), libeigen3-dev, libtbb-dev, libembree-dev, libpng-dev, libjpeg-dev, zlib1g-dev, libsqlite3-dev, libfmt-dev, libboost-dev, libnlopt-cxx-dev, libexif-dev, duktape-dev, nlohmann-json3-dev, libtomlplusplus-dev")
set(CPACK_COMPONENT_PALMAR_DESCRIPTION
    "How handheld products feel in people's hands before they exist\n Palmar takes a CAD model and a population of hands, grasps the product with\n each hand, simulates the contact of skin and product, and gives pressure maps,\n forces, areas, indices of the grasp, statistics, significance between designs\n and redesign proposals. `palmar serve` opens its workbench in a browser.")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
    "Libraries and headers of Palmar\n For programs of one's own that use Palmar's tasks: find_package(palmar).")
include(CPack)
