# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# Compiler settings shared by every target: the interface library palmar::compiler.

# CMake's own default for Release is -O3, which takes a seventh more time to build
# (docs/developing/build.md).
if(CMAKE_CXX_FLAGS_RELEASE STREQUAL "-O3 -DNDEBUG")
  set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG" CACHE STRING "Flags of release builds" FORCE)
endif()

# "Dev": optimised enough to run the whole test suite under the sanitizers.
set(CMAKE_CXX_FLAGS_DEV "-O1 -g1" CACHE STRING "")
set(CMAKE_C_FLAGS_DEV "-O1 -g1" CACHE STRING "")
set(CMAKE_EXE_LINKER_FLAGS_DEV "" CACHE STRING "")
set(CMAKE_SHARED_LINKER_FLAGS_DEV "" CACHE STRING "")

add_library(palmar_compiler INTERFACE)
add_library(palmar::compiler ALIAS palmar_compiler)
target_compile_features(palmar_compiler INTERFACE cxx_std_20)
# Sources that are compiled together (palmar_batches) know each other's file-local names, which a local
# name may repeat; what hides another local name is a mistake everywhere (Clang can't tell the two apart).
target_compile_options(palmar_compiler INTERFACE -Wall -Wextra -Wnon-virtual-dtor -ffp-contract=off -fno-math-errno
                       $<$<CXX_COMPILER_ID:GNU>:-Wshadow=local>)
# Loops that are made for vector instructions say so in GCC's words, and join conditions without branches.
target_compile_options(palmar_compiler INTERFACE
                       $<$<CXX_COMPILER_ID:Clang>:-Wno-unknown-pragmas -Wno-bitwise-instead-of-logical>)
# GCC 12 sees overlapping copies in "text" + std::string where there are none (GCC bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(palmar_compiler INTERFACE -Wno-restrict)
  if(PALMAR_PRECOMPILE)
    # From precompiled headers GCC 12 doesn't know any more that the code of the standard library isn't
    # ours, and sees copies of std::string there that leave their bounds (GCC bug 105329): said, but no
    # error. Builds without precompiled headers don't say it.
    target_compile_options(palmar_compiler INTERFACE -Wno-error=array-bounds -Wno-error=stringop-overflow
                                                      -Wno-error=stringop-overread)
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
# GDCM's headers read what isn't aligned; the types of objects can't be checked across the libraries.
set(palmar_sanitizers -fsanitize=address,undefined -fno-sanitize=alignment,vptr -fno-sanitize-recover=undefined
                      -fno-omit-frame-pointer)
if(PALMAR_SANITIZE)
  target_compile_options(palmar_compiler INTERFACE ${palmar_sanitizers})
  # GCC's word for what Clang says by __has_feature(address_sanitizer).
  target_compile_definitions(palmar_compiler INTERFACE $<$<CXX_COMPILER_ID:Clang>:__SANITIZE_ADDRESS__>)
  target_link_options(palmar_compiler INTERFACE -fsanitize=address,undefined)
  # What ran, for the libFuzzer targets (tests/fuzz).
  target_compile_options(palmar_compiler INTERFACE $<$<CXX_COMPILER_ID:Clang>:-fsanitize=fuzzer-no-link>)
endif()
if(PALMAR_TIDY)
  find_program(PALMAR_CLANG_TIDY clang-tidy REQUIRED)
  set(CMAKE_CXX_CLANG_TIDY ${PALMAR_CLANG_TIDY} --quiet)
endif()
