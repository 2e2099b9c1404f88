# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# palmar::opencascade: the parts of OpenCASCADE that the module cad uses, where it is installed; without
# it palmar-cad isn't built. Its own CMake package wants all of it, graphics too.
find_path(PALMAR_OCCT_INCLUDE Standard_Version.hxx PATH_SUFFIXES opencascade)
if(NOT PALMAR_OCCT_INCLUDE)
  message(STATUS "OpenCASCADE (libocct-data-exchange-dev) isn't installed: CAD files can't be read")
  return()
endif()
file(STRINGS ${PALMAR_OCCT_INCLUDE}/Standard_Version.hxx line REGEX "define OCC_VERSION_COMPLETE ")
string(REGEX REPLACE ".*\"(.*)\".*" "\\1" OpenCASCADE_VERSION "${line}")
add_library(palmar_opencascade INTERFACE)
add_library(palmar::opencascade ALIAS palmar_opencascade)
target_include_directories(palmar_opencascade SYSTEM INTERFACE ${PALMAR_OCCT_INCLUDE})
foreach(toolkit
    TKernel TKMath TKG2d TKG3d TKGeomBase TKBRep TKGeomAlgo TKTopAlgo TKPrim TKBO TKBool TKFillet TKOffset
    TKShHealing TKMesh TKFeat TKCDF TKLCAF TKCAF TKXSBase TKSTEPBase TKSTEPAttr TKSTEP209 TKSTEP TKIGES
    TKXCAF TKXDESTEP TKXDEIGES)
  find_library(PALMAR_OCCT_${toolkit} ${toolkit} REQUIRED)
  mark_as_advanced(PALMAR_OCCT_${toolkit})
  target_link_libraries(palmar_opencascade INTERFACE ${PALMAR_OCCT_${toolkit}})
endforeach()
