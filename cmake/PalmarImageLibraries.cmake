# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# Libraries for files of images that bring no CMake package that could be used.
#
# libexif: linked by its name (`exif`), so that an installed palmar::images can name it too.
find_path(PALMAR_EXIF_HEADERS libexif/exif-data.h REQUIRED)
find_library(PALMAR_EXIF exif REQUIRED)

# palmar::gdcm: the part of GDCM that unpacks compressed pixels, where it is installed; without it palmar-dicom
# isn't built. Found by header and libraries: Debian's GDCMConfig.cmake wants the packages of its tools and of
# its Python module beside it.
find_path(PALMAR_GDCM_HEADERS gdcmImage.h PATH_SUFFIXES gdcm-3.0)
if(PALMAR_GDCM_HEADERS)
  add_library(palmar_gdcm INTERFACE)
  add_library(palmar::gdcm ALIAS palmar_gdcm)
  target_include_directories(palmar_gdcm SYSTEM INTERFACE ${PALMAR_GDCM_HEADERS})
  foreach(part IN ITEMS MSFF DSED DICT Common)
    find_library(PALMAR_GDCM_${part} gdcm${part} REQUIRED)
    target_link_libraries(palmar_gdcm INTERFACE ${PALMAR_GDCM_${part}})
  endforeach()
else()
  message(STATUS "GDCM (libgdcm-dev) isn't installed: compressed DICOM images can't be read")
endif()
