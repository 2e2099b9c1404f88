# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# cmake -DSOURCE=... -DFOLDER=... -DCOMPILER=... -P check_configurations.cmake: the build can be configured
# on a machine that lacks optional libraries: all of them (what ./demo installs) and each one alone.
cmake_policy(VERSION 3.22)
set(without_cad -DCMAKE_IGNORE_PATH=/usr/include/opencascade)
set(without_opencv -DCMAKE_IGNORE_PATH=/usr/include/opencv4)
set(without_gdcm -DCMAKE_IGNORE_PATH=/usr/include/gdcm-3.0)
set(without_gtest -DCMAKE_DISABLE_FIND_PACKAGE_GTest=ON)
set(without_benchmark -DCMAKE_DISABLE_FIND_PACKAGE_benchmark=ON)
set(without_all "-DCMAKE_IGNORE_PATH=/usr/include/opencascade\;/usr/include/opencv4\;/usr/include/gdcm-3.0"
    ${without_gtest})

foreach(lacking IN ITEMS cad opencv gdcm gtest benchmark all)
  file(REMOVE_RECURSE ${FOLDER})
  execute_process(
    COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${FOLDER} -G Ninja -DCMAKE_BUILD_TYPE=Release
            -DCMAKE_CXX_COMPILER=${COMPILER} ${without_${lacking}}
    RESULT_VARIABLE code OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "Without ${lacking} the build can't be configured:\n${text}")
  endif()
endforeach()
file(REMOVE_RECURSE ${FOLDER})
