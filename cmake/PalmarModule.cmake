# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# palmar_module(NAME SOURCES ... [PUBLIC ...] [PRIVATE ...] [TESTS ...])
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
endfunction()

function(palmar_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE;TESTS;TEST_LINKS" ${ARGN})
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
  if(PALMAR_TESTS AND ARG_TESTS)
    add_executable(${name}_tests ${ARG_TESTS})
    target_link_libraries(${name}_tests PRIVATE palmar_${name} ${ARG_TEST_LINKS} GTest::gmock GTest::gtest_main)
    target_compile_definitions(${name}_tests PRIVATE PALMAR_SOURCE_DIR="${CMAKE_SOURCE_DIR}"
                                                     PALMAR_SHARED_DIR="${CMAKE_SOURCE_DIR}/../shared")
    palmar_add_tests(${name}_tests)
  endif()
endfunction()
