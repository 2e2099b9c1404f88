# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# Compiler settings shared by every target: the interface library palmar::compiler.

find_program(PALMAR_CCACHE ccache)
if(PALMAR_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Relative paths let clones in other folders share the cache.
  # What is read into a source is taken from the compiler's own list, without preprocessing it first.
  # How often the compiler collects garbage (below) doesn't change what it makes.
  set(palmar_ccache CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_DEPEND=1
                    CCACHE_IGNOREOPTIONS=--param=ggc-min-heapsize=*)
  if(PALMAR_PRECOMPILE)
    # ccache can't see into a precompiled header; its manual asks for this.
    list(APPEND palmar_ccache
         CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime)
  endif()
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env ${palmar_ccache} ${PALMAR_CCACHE})
endif()

# "Dev": optimised enough to run the whole test suite under the sanitizers.
set(CMAKE_CXX_FLAGS_DEV "-O2 -g1" CACHE STRING "")
set(CMAKE_C_FLAGS_DEV "-O2 -g1" CACHE STRING "")
set(CMAKE_EXE_LINKER_FLAGS_DEV "" CACHE STRING "")
set(CMAKE_SHARED_LINKER_FLAGS_DEV "" CACHE STRING "")

add_library(palmar_compiler INTERFACE)
add_library(palmar::compiler ALIAS palmar_compiler)
target_compile_features(palmar_compiler INTERFACE cxx_std_20)
target_compile_options(palmar_compiler INTERFACE -Wall -Wextra -Wshadow -Wnon-virtual-dtor
                                                  -ffp-contract=off -fno-math-errno)
# GCC 12 sees overlapping copies in "text" + std::string where there are none (GCC bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(palmar_compiler INTERFACE -Wno-restrict)
  if(PALMAR_PRECOMPILE)
    # From precompiled headers GCC 12 doesn't know any more that the code of the standard library isn't
    # ours, and warns there of std::string made of text in an initialiser list: "forming offset is out of
    # bounds" (char_traits.h), by the same mistake. Builds without them still warn.
    target_compile_options(palmar_compiler INTERFACE -Wno-array-bounds -Wno-stringop-overflow
                                                      -Wno-stringop-overread)
  endif()
endif()
if(PALMAR_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC clears its heap from 128 MB on, and reads all of a precompiled header for that; from 1 GB on, it
  # compiles in 15 to 20 % less time.
  target_compile_options(palmar_compiler INTERFACE --param=ggc-min-heapsize=1000000)
endif()
if(PALMAR_WERROR)
  target_compile_options(palmar_compiler INTERFACE -Werror)
endif()
if(PALMAR_SANITIZE)
  target_compile_options(palmar_compiler INTERFACE -fsanitize=address,undefined
                                                    -fno-sanitize-recover=undefined
                                                    -fno-omit-frame-pointer)
  target_link_options(palmar_compiler INTERFACE -fsanitize=address,undefined)
endif()
if(PALMAR_TIDY)
  find_program(PALMAR_CLANG_TIDY clang-tidy REQUIRED)
  set(CMAKE_CXX_CLANG_TIDY ${PALMAR_CLANG_TIDY} --quiet)
endif()
