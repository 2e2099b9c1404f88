# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# palmar_read_modules(VARIABLE FILE): the names in FILE, a modules.txt, bottom to top.
function(palmar_read_modules variable file)
  file(STRINGS ${file} lines REGEX "^[a-z_]+:")
  set(names "")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "^([a-z_]+):.*" "\\1" name "${line}")
    list(APPEND names ${name})
  endforeach()
  if(NOT names)
    message(FATAL_ERROR "${file} names no module; lines like \"core: what it is\" are required")
  endif()
  set(${variable} ${names} PARENT_SCOPE)
endfunction()
