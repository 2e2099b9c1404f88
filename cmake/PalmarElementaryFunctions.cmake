# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# sin, exp, pow and the like out of musl's C library. Those of glibc differ in the last bit with the processor
# (it takes the fused multiply-add where there is one), and a search for a grasp makes the sixth digit of a
# force of that. musl has one version of each for all processors of an architecture.
#
# palmar::elementary: to link behind everything that calls them. Without musl (Debian: musl-dev) it holds
# nothing, and the C library's own are used.

add_library(palmar_elementary INTERFACE)
add_library(palmar::elementary ALIAS palmar_elementary)
set(PALMAR_HAS_ELEMENTARY OFF)

# The sanitizers put theirs in between.
if(NOT PALMAR_SANITIZE)
  find_file(PALMAR_MUSL_LIBC libc.a
            PATHS /usr/lib/${CMAKE_SYSTEM_PROCESSOR}-linux-musl /usr/local/musl/lib NO_DEFAULT_PATH
            DOC "musl's static C library")
endif()
if(PALMAR_MUSL_LIBC)
  set(members acos asin atan atan2 cbrt cos cosh erf exp exp2 expm1 hypot lgamma lgamma_r log log10 log1p log2 pow
              powf sin sincos sinh tan tanh tgamma
              # what these call or read
              __cos __expo2 __math_divzero __math_invalid __math_invalidf __math_oflow __math_oflowf __math_uflow
              __math_uflowf __math_xflow __math_xflowf __rem_pio2 __rem_pio2_large __sin __tan exp2f_data exp_data
              log2_data log_data pow_data powf_data signgam)
  list(TRANSFORM members APPEND .lo)
  set(folder ${CMAKE_BINARY_DIR}/elementary)
  set(library ${folder}/libpalmar_elementary.a)
  if(NOT EXISTS ${library} OR ${PALMAR_MUSL_LIBC} IS_NEWER_THAN ${library})
    file(REMOVE_RECURSE ${folder})
    file(MAKE_DIRECTORY ${folder})
    execute_process(COMMAND ${CMAKE_AR} x ${PALMAR_MUSL_LIBC} ${members} WORKING_DIRECTORY ${folder}
                    COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND ${CMAKE_AR} rcs ${library} ${members} WORKING_DIRECTORY ${folder}
                    COMMAND_ERROR_IS_FATAL ANY)
  endif()
  target_link_libraries(palmar_elementary INTERFACE $<BUILD_INTERFACE:${library}>)
  set(PALMAR_HAS_ELEMENTARY ON)
else()
  message(STATUS "musl isn't installed: the last digits of results depend on the processor")
endif()
palmar_export(palmar_elementary elementary)
