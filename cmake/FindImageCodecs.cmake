# SPDX-License-Identifier: Apache-2.0
# ImageCodecs::ImageCodecs: libdeflate (for PNG) and TurboJPEG. Headers are system headers.
find_path(ImageCodecs_libdeflate_INCLUDE_DIR libdeflate.h)
find_library(ImageCodecs_libdeflate_LIBRARY deflate)
find_path(ImageCodecs_turbojpeg_INCLUDE_DIR turbojpeg.h)
find_library(ImageCodecs_turbojpeg_LIBRARY turbojpeg)
set(image_codecs_variables ImageCodecs_libdeflate_INCLUDE_DIR ImageCodecs_libdeflate_LIBRARY
                           ImageCodecs_turbojpeg_INCLUDE_DIR ImageCodecs_turbojpeg_LIBRARY)
mark_as_advanced(${image_codecs_variables})

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(ImageCodecs REQUIRED_VARS ${image_codecs_variables})
if(ImageCodecs_FOUND AND NOT TARGET ImageCodecs::ImageCodecs)
  add_library(ImageCodecs::ImageCodecs INTERFACE IMPORTED)
  if(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL)
    set_target_properties(ImageCodecs::ImageCodecs PROPERTIES IMPORTED_GLOBAL ON)
  endif()
  target_include_directories(ImageCodecs::ImageCodecs SYSTEM INTERFACE ${ImageCodecs_libdeflate_INCLUDE_DIR}
                             ${ImageCodecs_turbojpeg_INCLUDE_DIR})
  target_link_libraries(ImageCodecs::ImageCodecs INTERFACE ${ImageCodecs_libdeflate_LIBRARY}
                        ${ImageCodecs_turbojpeg_LIBRARY})
endif()
