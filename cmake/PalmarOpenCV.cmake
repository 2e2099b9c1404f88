# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# palmar::opencv: the parts of OpenCV 4 that the module board uses, where they are installed; without
# them palmar-photo isn't built. Debian's own CMake package wants all of OpenCV.
find_path(PALMAR_OPENCV_INCLUDE opencv2/aruco/charuco.hpp PATH_SUFFIXES opencv4)
set(PALMAR_OPENCV_LIBRARIES "")
set(palmar_opencv_is_whole ${PALMAR_OPENCV_INCLUDE})
foreach(part core imgproc calib3d features2d aruco)
  find_library(PALMAR_OPENCV_${part} opencv_${part})
  mark_as_advanced(PALMAR_OPENCV_${part})
  list(APPEND PALMAR_OPENCV_LIBRARIES ${PALMAR_OPENCV_${part}})
  if(NOT PALMAR_OPENCV_${part})
    set(palmar_opencv_is_whole NO)
  endif()
endforeach()
if(palmar_opencv_is_whole)
  add_library(palmar_opencv INTERFACE)
  add_library(palmar::opencv ALIAS palmar_opencv)
  target_include_directories(palmar_opencv SYSTEM INTERFACE ${PALMAR_OPENCV_INCLUDE})
  target_link_libraries(palmar_opencv INTERFACE ${PALMAR_OPENCV_LIBRARIES})
else()
  message(STATUS "OpenCV with aruco (libopencv-contrib-dev) isn't installed: `palmar photos` will be missing")
endif()
