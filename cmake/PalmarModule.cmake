# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# palmar_module(NAME [BATCHED] SOURCES ... [PUBLIC ...] [PRIVATE ...] [TESTS ...])
#
# One static library palmar_NAME (alias palmar::NAME) per folder of src/palmar and one test program
# NAME_tests from the *_test.cpp files beside the sources. A module can only link modules that were
# added before it, so the order of add_subdirectory() in src/palmar/CMakeLists.txt is the layering;
# tests/check_layers.cmake holds the #include lines to the same order.

# One ctest entry per test program, not per test: what a program prepares for its tests (a hand, an
# assessment) is prepared once. `PROGRAM --gtest_filter=...` runs single tests.
# palmar_add_tests(PROGRAM slow): minutes under the sanitizers, so ./check runs it in Release only.
function(palmar_add_tests program)
  add_test(NAME ${program} COMMAND ${program})
  set_tests_properties(${program} PROPERTIES TIMEOUT 1500 LABELS "${ARGN}")
  palmar_use_headers(${program} palmar_test_headers ${palmar_light})
  palmar_batches(${program})
endfunction()

# With PALMAR_PRECOMPILE: half of what a module's source costs to compile is reading Eigen and the standard
# library, half of what a test costs is GoogleTest, and a command reads CLI11, fmt and nlohmann_json. Each
# set is read once and used by all. GCC takes the level of optimisation from the precompiled header;
# tests, commands and BATCHED modules hold no loops that take time, so theirs is lower. Sources include
# what they use all the same: the `tidy` preset and builds by hand do without.
#
# At -O1 GCC can't tell whether a std::optional has been set; such a warning is none to stop at.
set(palmar_light -O1 -Wno-error=maybe-uninitialized)

# palmar_headers(NAME HEADERS ... LINKS ... OPTIONS ...); palmar_use_headers(TARGET NAME OPTION...)
function(palmar_headers name)
  cmake_parse_arguments(ARG "" "" "HEADERS;LINKS;OPTIONS" ${ARGN})
  add_library(${name} OBJECT EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/cmake/headers.cpp)
  target_link_libraries(${name} PRIVATE palmar::compiler ${ARG_LINKS})
  target_compile_options(${name} PRIVATE ${ARG_OPTIONS})
  target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
endfunction()

function(palmar_use_headers target headers)
  if(PALMAR_PRECOMPILE)
    target_compile_options(${target} PRIVATE ${ARGN})
    target_link_libraries(${target} PRIVATE Eigen3::Eigen)
    target_precompile_headers(${target} REUSE_FROM ${headers})
  endif()
endfunction()

if(PALMAR_PRECOMPILE)
  set(palmar_common <Eigen/Dense> <algorithm> <cmath> <functional> <map> <memory> <optional> <sstream>
                    <string> <unordered_map> <vector>)
  palmar_headers(palmar_module_headers HEADERS ${palmar_common} LINKS Eigen3::Eigen)
  palmar_headers(palmar_light_headers
                 HEADERS ${palmar_common} <CLI/CLI.hpp> <fmt/format.h> <nlohmann/json.hpp>
                 LINKS Eigen3::Eigen CLI11::CLI11 fmt::fmt nlohmann_json::nlohmann_json OPTIONS ${palmar_light})
  if(PALMAR_TESTS)
    palmar_headers(palmar_test_headers HEADERS <gmock/gmock.h> <gtest/gtest.h> <Eigen/Dense>
                   LINKS Eigen3::Eigen GTest::gmock OPTIONS ${palmar_light})
  endif()
endif()

# Sources of tests, commands and BATCHED modules are compiled six at a time, in the order of their list:
# what GoogleTest, nlohmann_json and CLI11 put into each is made once for all of them, which halves their
# time. Names in the anonymous namespaces of a batch have to differ; what is local may have the name of
# something in another source (builds without batches still warn of shadows in one source). Eigen's
# templates hardly repeat from source to source, so the other modules gain nothing.
add_library(palmar_batch_warnings INTERFACE)  # linked last: after palmar::compiler's -Wshadow
target_compile_options(palmar_batch_warnings INTERFACE -Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wshadow=local>)
function(palmar_batches target)
  if(PALMAR_PRECOMPILE)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 6)
    target_link_libraries(${target} PRIVATE palmar_batch_warnings)
  endif()
endfunction()

function(palmar_module name)
  cmake_parse_arguments(ARG "BATCHED" "" "SOURCES;PUBLIC;PRIVATE;TESTS;TEST_LINKS" ${ARGN})
  foreach(dependency IN LISTS ARG_PUBLIC ARG_PRIVATE)
    if(dependency MATCHES "^palmar::" AND NOT TARGET ${dependency})
      message(FATAL_ERROR "Module ${name} links ${dependency}, which stands below it (or does not exist). "
                          "See the order in src/palmar/CMakeLists.txt.")
    endif()
  endforeach()
  add_library(palmar_${name} STATIC ${ARG_SOURCES})
  add_library(palmar::${name} ALIAS palmar_${name})
  target_include_directories(palmar_${name} PUBLIC ${CMAKE_SOURCE_DIR}/src)
  target_link_libraries(palmar_${name} PUBLIC palmar::compiler ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  if(ARG_BATCHED)
    palmar_use_headers(palmar_${name} palmar_light_headers ${palmar_light})
    palmar_batches(palmar_${name})
  elseif(NOT name STREQUAL core)  # knows no Eigen
    palmar_use_headers(palmar_${name} palmar_module_headers)
  endif()
  if(PALMAR_TESTS AND ARG_TESTS)
    add_executable(${name}_tests ${ARG_TESTS})
    target_link_libraries(${name}_tests PRIVATE palmar_${name} ${ARG_TEST_LINKS} GTest::gmock GTest::gtest_main)
    target_compile_definitions(${name}_tests PRIVATE PALMAR_SOURCE_DIR="${CMAKE_SOURCE_DIR}"
                                                     PALMAR_SHARED_DIR="${CMAKE_SOURCE_DIR}/../shared")
    palmar_add_tests(${name}_tests)
  endif()
endfunction()
