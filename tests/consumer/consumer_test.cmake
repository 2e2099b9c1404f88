# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# cmake -DBUILD=... -DCONSUMER=... -DCOMPILER=... -P consumer_test.cmake: installs Palmar into the build
# folder, builds the project CONSUMER against what was installed, runs it and checks what it prints.
cmake_policy(VERSION 3.22)
set(prefix ${BUILD}/consumer/installed)
set(folder ${BUILD}/consumer/build)
file(REMOVE_RECURSE ${prefix} ${folder})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE text ERROR_VARIABLE errors)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nended with ${code}:\n${text}\n${errors}")
  endif()
  set(output "${text}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
run(${CMAKE_COMMAND} -S ${CONSUMER} -B ${folder} -G Ninja -DCMAKE_BUILD_TYPE=Release
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${folder})
run(${folder}/consumer)
message(STATUS "${output}")
if(NOT output MATCHES "medium_wrap, ([0-9.]+) N on ([0-9.]+) mm2")
  message(FATAL_ERROR "A medium wrap with its force and area was expected; the consumer printed: ${output}")
endif()
if(CMAKE_MATCH_1 LESS 1 OR CMAKE_MATCH_1 GREATER 1000 OR CMAKE_MATCH_2 LESS 100 OR CMAKE_MATCH_2 GREATER 30000)
  message(FATAL_ERROR "No hand holds a 35 mm cylinder so: ${output}")
endif()

# What is installed is whole: each header includes only what is installed, and no library but Eigen.
file(GLOB_RECURSE headers RELATIVE ${prefix}/include ${prefix}/include/palmar/*.h)
foreach(header IN LISTS headers)
  file(STRINGS ${prefix}/include/${header} includes REGEX "^#include")
  foreach(line IN LISTS includes)
    if(line MATCHES "\"(palmar/[^\"]+)\"")
      if(NOT EXISTS ${prefix}/include/${CMAKE_MATCH_1})
        message(FATAL_ERROR "${header} is installed and includes ${CMAKE_MATCH_1}, which isn't")
      endif()
    elseif(NOT line MATCHES "<(Eigen/[A-Za-z]+|[a-z_]+)>")
      message(FATAL_ERROR "${header} is installed and has ${line}: only Eigen and the standard library may "
                          "stand in a public header")
    endif()
  endforeach()
endforeach()
list(LENGTH headers count)
message(STATUS "${count} headers are installed")
