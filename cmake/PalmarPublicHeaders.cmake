# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# palmar_public_headers(VARIABLE FOLDER): the headers of FOLDER (src) that are installed, as paths in it.
#
# Public is a header of the layer workflow, and one that another module includes; and what a public one
# includes. A header that only its own module includes is internal, and so is one that includes a library
# other than Eigen: fails if a public one includes such a header.
cmake_policy(VERSION 3.22)

function(palmar_public_headers variable folder)
  file(GLOB_RECURSE headers RELATIVE ${folder} ${folder}/palmar/*.h)
  file(GLOB_RECURSE sources RELATIVE ${folder} ${folder}/palmar/*.cpp)
  list(FILTER sources EXCLUDE REGEX "_test\\.cpp$")
  set(public "")
  foreach(file IN LISTS headers sources)
    file(STRINGS ${folder}/${file} lines REGEX "^#include [\"<]")
    string(REGEX MATCHALL "\"palmar/[^\"]+\"" ours "${lines}")
    string(REPLACE "\"" "" ours "${ours}")
    string(REGEX REPLACE "^palmar/([^/]+)/.*" "\\1" module ${file})
    foreach(header IN LISTS ours)
      if(NOT header MATCHES "^palmar/${module}/")
        list(APPEND public ${header})
      endif()
    endforeach()
    if(file MATCHES "\\.h$")
      set(includes_${file} ${ours})
      # What has a folder or an ending in its name and isn't Eigen's or the system's.
      string(REGEX MATCHALL "<(nlohmann|toml\\+\\+|embree[0-9]*|CLI|fmt|boost|gtest|gmock|opencv2|tbb|nlopt)[^>]*>" theirs
                            "${lines}")
      set(library_${file} ${theirs})
      if(file MATCHES "^palmar/workflow/[a-z_]+\\.h$")
        list(APPEND public ${file})
      endif()
    endif()
  endforeach()
  list(REMOVE_DUPLICATES public)
  foreach(header IN LISTS public)
    if(library_${header})
      list(REMOVE_ITEM public ${header})
    endif()
  endforeach()
  # And what those include.
  set(next ${public})
  while(next)
    set(more "")
    foreach(header IN LISTS next)
      foreach(included IN LISTS includes_${header})
        if(library_${included})
          message(FATAL_ERROR "${header} is public and includes ${included}, which includes "
                              "${library_${included}}: no library but Eigen may stand in a public header")
        endif()
        if(NOT included IN_LIST public)
          list(APPEND public ${included})
          list(APPEND more ${included})
        endif()
      endforeach()
    endforeach()
    set(next ${more})
  endwhile()
  list(SORT public)
  set(${variable} ${public} PARENT_SCOPE)
endfunction()

# Copies them there, each into its folder.
function(palmar_install_public_headers folder destination)
  palmar_public_headers(public ${folder})
  foreach(header IN LISTS public)
    get_filename_component(place ${header} DIRECTORY)
    file(INSTALL ${folder}/${header} DESTINATION ${destination}/${place} MESSAGE_NEVER)
  endforeach()
  list(LENGTH public count)
  message(STATUS "Installed ${count} public headers")
endfunction()
