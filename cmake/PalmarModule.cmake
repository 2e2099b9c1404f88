# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# palmar_module(NAME [WITH_JSON] SOURCES ... [PUBLIC ...] [PRIVATE ...] [TESTS ...])
#
# One static library palmar_NAME (alias palmar::NAME) per folder of src/palmar and src/hands and one test program
# NAME_tests from the *_test.cpp files beside the sources. A module can only link modules that were
# added before it, so the order of the modules.txt of both houses is the layering;
# tests/layers/layers.mjs holds the #include lines to the same order.

# The house next door, src/hands with its programs, is built and tested apart: `all` builds everything, the target
# `palmar_house` all but that house. palmar_in_house(TARGET) adds to that target what isn't of src/hands; ctest entries
# of that house have the label `hands`.
add_custom_target(palmar_house)
function(palmar_is_hands variable)
  set(${variable} OFF PARENT_SCOPE)
  if(CMAKE_CURRENT_SOURCE_DIR MATCHES "/src/hands|/tests/hands|/apps/palmar-(hands|photo|dicom)")
    set(${variable} ON PARENT_SCOPE)
  endif()
endfunction()
function(palmar_in_house)
  palmar_is_hands(hands)
  # What begins with release_ runs before a release. Clang runs the tests of core and formats as sanitized_readers.
  set(left_out "^release_")
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    string(APPEND left_out "|^(core|formats)_tests$")
  endif()
  if(NOT hands AND NOT "${ARGN}" MATCHES "${left_out}")
    add_dependencies(palmar_house ${ARGN})
  endif()
endfunction()

# palmar_export(TARGET NAME): installed, for other projects palmar::NAME (cmake/PalmarInstall.cmake).
function(palmar_export target name)
  palmar_is_hands(hands)
  if(hands)
    return()
  endif()
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS ${target} EXPORT palmar ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/palmar
          COMPONENT development)
endfunction()

# One ctest entry per test program of a module, not per test: what a program prepares for its tests (a hand, an
# assessment) is prepared once. `PROGRAM --gtest_filter=...` runs single tests. Tests that begin with `Thorough`
# stand in an entry NAME_thorough of their own with the label `release`: ./check --full alone runs those.
function(palmar_add_entry program name filter sources labels)
  palmar_is_hands(hands)
  if(hands)
    list(APPEND labels hands)
  endif()
  add_test(NAME ${name} COMMAND ${program} --gtest_filter=${filter}-*Thorough*)
  set_tests_properties(${name} PROPERTIES TIMEOUT 1500 LABELS "${labels}"
                       ENVIRONMENT "GTEST_OUTPUT=xml:${CMAKE_BINARY_DIR}/test_results/${name}.xml")
  foreach(source IN LISTS sources)
    file(STRINGS ${source} thorough REGEX "^TEST.*, Thorough" LIMIT_COUNT 1)
    if(thorough)
      string(REPLACE ".*" ".Thorough*" patterns "${filter}")
      string(REGEX REPLACE "^\\*$" "*.Thorough*" patterns "${patterns}")
      add_test(NAME ${name}_thorough COMMAND ${program} --gtest_filter=${patterns})
      set_tests_properties(${name}_thorough PROPERTIES TIMEOUT 1500 LABELS "release;${labels}"
                           ENVIRONMENT "GTEST_OUTPUT=xml:${CMAKE_BINARY_DIR}/test_results/${name}_thorough.xml")
      break()
    endif()
  endforeach()
endfunction()

function(palmar_test_target program)
  palmar_in_house(${program})
  palmar_use_headers(${program} palmar_test_headers)
  target_compile_options(${program} PRIVATE ${palmar_once})
  target_include_directories(${program} PRIVATE ${CMAKE_SOURCE_DIR}/tests)
  target_compile_definitions(${program} PRIVATE
    PALMAR_SOURCE_DIR="${CMAKE_SOURCE_DIR}" PALMAR_SHARED_DIR="${CMAKE_SOURCE_DIR}/../shared"
    PALMAR_HAND_ASSET="${CMAKE_SOURCE_DIR}/node_modules/@webxr-input-profiles/assets/dist/profiles/generic-hand/right.glb")
endfunction()

# palmar_test_program(NAME LIBRARY ...): a test program of several subjects, which palmar_test() adds:
# palmar_test(PROGRAM NAME [SOURCES ...] [FILTER PATTERN] [LABELS ...]): the tests of these sources as one ctest
# entry. Label `release`: before a release only.
function(palmar_test_program name)
  add_executable(${name})
  target_link_libraries(${name} PRIVATE ${ARGN} GTest::gmock GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE PALMAR_EXECUTABLE="$<TARGET_FILE:palmar>")
  if(TARGET palmar-cad)
    target_compile_definitions(${name} PRIVATE PALMAR_CAD_PROGRAM="$<TARGET_FILE:palmar-cad>")
  endif()
  palmar_test_target(${name})
  if(NOT name MATCHES "^release_")  # sources of one batch need different names, which seldom built ones needn't have
    palmar_batches(${name} 5)
  endif()
endfunction()

function(palmar_test program name)
  cmake_parse_arguments(ARG "" "FILTER" "SOURCES;LABELS" ${ARGN})
  target_sources(${program} PRIVATE ${ARG_SOURCES})
  set(patterns ${ARG_FILTER})
  if(NOT ARG_FILTER)
    foreach(source IN LISTS ARG_SOURCES)
      file(STRINGS ${source} heads REGEX "^TEST(_F|_P)?\\(")
      set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
      foreach(head IN LISTS heads)
        string(REGEX REPLACE "^TEST[_FP]*\\(([A-Za-z0-9]+).*" "\\1" suite "${head}")
        list(APPEND patterns ${suite}.* */${suite}.*)
      endforeach()
    endforeach()
    list(REMOVE_DUPLICATES patterns)
  endif()
  list(JOIN patterns ":" filter)
  palmar_add_entry(${program} ${name} "${filter}" "${ARG_SOURCES}" "${ARG_LABELS}")
endfunction()

# With PALMAR_PRECOMPILE: half of what a module's source costs to compile is reading Eigen and the standard
# library, half of what a test costs is GoogleTest, and a command reads CLI11, fmt and nlohmann_json. Each
# set is read once and used by all. Sources include what they use all the same: the `tidy` preset and
# builds by hand do without.
#
# The modules go into programs and into the Python module, which is a shared object. What only a program links
# needs no code for that. Hidden, their functions call each other as directly as in a program.
function(palmar_shareable target)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden
                                             VISIBILITY_INLINES_HIDDEN ON)
endfunction()

# palmar_headers(NAME HEADERS ... LINKS ...); palmar_use_headers(TARGET NAME)
function(palmar_headers name)
  cmake_parse_arguments(ARG "" "" "HEADERS;LINKS" ${ARGN})
  add_library(${name} OBJECT EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/cmake/precompiled/headers.cpp)
  target_link_libraries(${name} PRIVATE palmar::compiler ${ARG_LINKS})
  target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
endfunction()

function(palmar_use_headers target headers)
  if(PALMAR_PRECOMPILE)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:Eigen3::Eigen> fmt::fmt palmar_eigen)
    target_precompile_headers(${target} REUSE_FROM ${headers})
  endif()
endfunction()

# With -O2 GCC 12 makes vector instructions only of loops whose length it knows, with -O3 of all that gain by
# it: contact, distances and geodesics take half of the time. Where headers are precompiled, their -O counts.
# What tests and commands cost is compiling them: -O1 takes a quarter less than -O2.
# What writes and reads JSON is large and runs briefly: Clang inlines less of it, which takes a tenth less time.
set(palmar_computes "")
set(palmar_once "")
set(palmar_describes "")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(palmar_computes $<$<CONFIG:Release>:-O3>)
  set(palmar_once $<$<CONFIG:Release>:-O1>)
else()
  set(palmar_once $<$<CONFIG:Release>:-O0>)
  set(palmar_describes $<$<CONFIG:Release>:SHELL:-mllvm -inline-threshold=100>)
endif()

if(PALMAR_PRECOMPILE)
  # What the headers declare as made elsewhere (see there).
  set(folder ${PROJECT_SOURCE_DIR}/cmake/precompiled)
  add_library(palmar_eigen STATIC ${folder}/eigen_cholesky.cpp ${folder}/eigen_orthogonal.cpp
                                  ${folder}/eigen_products.cpp)
  target_link_libraries(palmar_eigen PUBLIC palmar::elementary PRIVATE $<BUILD_INTERFACE:palmar::compiler> Eigen3::Eigen)
  palmar_shareable(palmar_eigen)
  palmar_export(palmar_eigen eigen)
  set(palmar_common <Eigen/Dense> <algorithm> <array> <cmath> <filesystem> <functional> <limits> <map> <memory>
                    <numbers> <numeric> <optional> <random> <set> <span> <sstream> <string> <string_view>
                    <unordered_map> <vector> <fmt/format.h> ${folder}/eigen_instances.h)
  palmar_headers(palmar_module_headers HEADERS ${palmar_common} LINKS Eigen3::Eigen fmt::fmt)
  target_compile_options(palmar_module_headers PRIVATE ${palmar_computes})
  palmar_shareable(palmar_module_headers)
  # CLI11's classes have virtual functions, which GCC makes in every source that knows them: 5 s each.
  palmar_headers(palmar_json_headers HEADERS ${palmar_common} <nlohmann/json.hpp>
                 LINKS Eigen3::Eigen fmt::fmt nlohmann_json::nlohmann_json)
  palmar_shareable(palmar_json_headers)
  palmar_headers(palmar_command_headers HEADERS ${palmar_common} <CLI/CLI.hpp> <nlohmann/json.hpp>
                 LINKS Eigen3::Eigen CLI11::CLI11 fmt::fmt nlohmann_json::nlohmann_json)
  target_compile_options(palmar_command_headers PRIVATE ${palmar_once})
  if(PALMAR_TESTS)
    palmar_headers(palmar_test_headers HEADERS <gmock/gmock.h> <gtest/gtest.h> ${folder}/eigen_instances.h
                   LINKS Eigen3::Eigen GTest::gmock fmt::fmt)
    target_compile_options(palmar_test_headers PRIVATE ${palmar_once})
  endif()
endif()

# Sources are compiled some at a time, in the order of their list: what Eigen, GoogleTest, nlohmann_json and
# CLI11 put into each is made once for all of them, which halves the time of tests and commands. Names in the
# anonymous namespaces of a batch have to differ. Few to a batch where each takes long: both processors stay
# busy, and a change of one source doesn't compile many others.
function(palmar_batches target size)
  if(PALMAR_PRECOMPILE)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${size})
    # A batch includes its sources, so that GCC takes what they keep to themselves for a header's.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
    endif()
  endif()
endfunction()

function(palmar_module name)
  cmake_parse_arguments(ARG "WITH_JSON" "" "SOURCES;PUBLIC;PRIVATE;TESTS;TEST_LINKS" ${ARGN})
  foreach(dependency IN LISTS ARG_PUBLIC ARG_PRIVATE)
    if(dependency MATCHES "^palmar::" AND NOT TARGET ${dependency})
      message(FATAL_ERROR "Module ${name} links ${dependency}, which stands below it (or does not exist). "
                          "See the order in modules.txt.")
    endif()
  endforeach()
  if(NOT ARG_SOURCES)  # a part that has none yet
    add_library(palmar_${name} INTERFACE)
    add_library(palmar::${name} ALIAS palmar_${name})
    target_link_libraries(palmar_${name} INTERFACE ${ARG_PUBLIC} ${ARG_PRIVATE})
    palmar_export(palmar_${name} ${name})
    return()
  endif()
  add_library(palmar_${name} STATIC ${ARG_SOURCES})
  palmar_shareable(palmar_${name})
  add_library(palmar::${name} ALIAS palmar_${name})
  target_include_directories(palmar_${name} PUBLIC $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/src>
                                                   $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(palmar_${name} PUBLIC cxx_std_20)
  # Who links an installed module needs neither our warnings nor the libraries that are headers only.
  if("tomlplusplus::tomlplusplus" IN_LIST ARG_PRIVATE)  # has a library beside its headers
    list(APPEND ARG_PRIVATE $<INSTALL_INTERFACE:tomlplusplus>)
  endif()
  list(TRANSFORM ARG_PRIVATE REPLACE "^(nlohmann_json::nlohmann_json|tomlplusplus::tomlplusplus)$"
                                     "$<BUILD_INTERFACE:\\1>")
  target_link_libraries(palmar_${name} PUBLIC $<BUILD_INTERFACE:palmar::compiler> ${ARG_PUBLIC}
                                       PRIVATE ${ARG_PRIVATE})
  if(NOT name MATCHES "^(cad|board|server)$")  # of the programs palmar-cad, palmar-photo and palmar-serve alone
    palmar_export(palmar_${name} ${name})
  endif()
  if(ARG_WITH_JSON)
    palmar_use_headers(palmar_${name} palmar_json_headers)
    target_compile_options(palmar_${name} PRIVATE ${palmar_describes})
    palmar_batches(palmar_${name} 6)
  elseif(NOT name STREQUAL core)  # knows no Eigen
    palmar_use_headers(palmar_${name} palmar_module_headers)
    target_compile_options(palmar_${name} PRIVATE ${palmar_computes})
    if(NOT name MATCHES "^(cad|board)$")  # OpenCASCADE and OpenCV
      palmar_batches(palmar_${name} 4)
    endif()
  endif()
  if(PALMAR_TESTS AND ARG_TESTS)
    add_executable(${name}_tests ${ARG_TESTS})
    target_link_libraries(${name}_tests PRIVATE palmar_${name} ${ARG_TEST_LINKS} GTest::gmock GTest::gtest_main)
    palmar_test_target(${name}_tests)
    palmar_batches(${name}_tests 8)
    palmar_add_entry(${name}_tests ${name}_tests "*" "${ARG_TESTS}" "")
  endif()
endfunction()
