# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# Writes FILE, what `palmar --version` says of the build, if it changed: the commit of SOURCE ("+changes" if
# files differ from it; nothing outside of a clone) and LIBRARIES. A file rather than part of the program:
# a commit must not link everything anew.
set(text "")
find_program(git git)
if(git AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${git} -C ${SOURCE} describe --always --abbrev=10 --exclude=* --dirty=+changes
                  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(commit)
    set(text "commit ${commit}\n")
  endif()
endif()
string(APPEND text "libraries: ${LIBRARIES}\n")
set(before "")
if(EXISTS ${FILE})
  file(READ ${FILE} before)
endif()
if(NOT text STREQUAL before)
  file(WRITE ${FILE} "${text}")
endif()
