# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# cmake -DSOURCE=<src/palmar> -P check_layers.cmake
#
# Holds every #include "palmar/MODULE/..." to the layering: a module includes only itself and what
# stands above it in src/palmar/modules.txt.
cmake_policy(SET CMP0057 NEW)
include(${CMAKE_CURRENT_LIST_DIR}/../cmake/PalmarModules.cmake)
palmar_read_modules(modules ${SOURCE}/modules.txt)

set(violations "")
set(files_read 0)
foreach(module IN LISTS modules)
  list(FIND modules ${module} own_rank)
  file(GLOB_RECURSE files ${SOURCE}/${module}/*.h ${SOURCE}/${module}/*.cpp)
  foreach(file IN LISTS files)
    math(EXPR files_read "${files_read} + 1")
    file(STRINGS ${file} includes REGEX "^#include \"palmar/")
    foreach(line IN LISTS includes)
      string(REGEX REPLACE "^#include \"palmar/([^/\"]+)/.*" "\\1" other "${line}")
      list(FIND modules "${other}" other_rank)
      if(other_rank EQUAL -1 OR other_rank GREATER own_rank)
        list(APPEND violations "${file}: ${line}\n")
      endif()
    endforeach()
  endforeach()
endforeach()
file(GLOB folders RELATIVE ${SOURCE} ${SOURCE}/*)
foreach(folder IN LISTS folders)
  if(IS_DIRECTORY ${SOURCE}/${folder} AND NOT folder IN_LIST modules)
    list(APPEND violations "${SOURCE}/${folder}: not in src/palmar/modules.txt\n")
  endif()
endforeach()
if(files_read EQUAL 0)
  message(FATAL_ERROR "No source was found under ${SOURCE}")
endif()
if(violations)
  message(FATAL_ERROR "Includes against the layering:\n${violations}")
endif()
message(STATUS "${files_read} files respect the layering")
