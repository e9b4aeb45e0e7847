# SPDX-License-Identifier: Apache-2.0
# OpenCVImages::OpenCVImages: core, imgproc and imgcodecs of OpenCV 4, found without OpenCV's own configuration file, which
# Debian ships only in libopencv-dev (the whole of OpenCV). Headers are system headers.
find_path(OpenCVImages_INCLUDE_DIR opencv2/imgcodecs.hpp PATH_SUFFIXES opencv4)
set(OpenCVImages_LIBRARIES "")
foreach(module imgcodecs imgproc core)
  find_library(OpenCVImages_${module}_LIBRARY opencv_${module})
  list(APPEND OpenCVImages_LIBRARIES ${OpenCVImages_${module}_LIBRARY})
endforeach()
mark_as_advanced(OpenCVImages_INCLUDE_DIR OpenCVImages_imgcodecs_LIBRARY OpenCVImages_imgproc_LIBRARY
                 OpenCVImages_core_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenCVImages REQUIRED_VARS OpenCVImages_INCLUDE_DIR OpenCVImages_imgcodecs_LIBRARY
                                  OpenCVImages_imgproc_LIBRARY OpenCVImages_core_LIBRARY)
if(OpenCVImages_FOUND AND NOT TARGET OpenCVImages::OpenCVImages)
  add_library(OpenCVImages::OpenCVImages INTERFACE IMPORTED)
  if(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL)
    set_target_properties(OpenCVImages::OpenCVImages PROPERTIES IMPORTED_GLOBAL ON)
  endif()
  target_include_directories(OpenCVImages::OpenCVImages SYSTEM INTERFACE ${OpenCVImages_INCLUDE_DIR})
  target_link_libraries(OpenCVImages::OpenCVImages INTERFACE ${OpenCVImages_LIBRARIES})
endif()
