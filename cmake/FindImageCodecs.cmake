# SPDX-License-Identifier: Apache-2.0
# ImageCodecs::ImageCodecs: libpng, TurboJPEG and libtiff (4.5 or later). Headers are system headers.
find_package(PNG QUIET)
find_package(TIFF 4.5 QUIET)
find_path(ImageCodecs_turbojpeg_INCLUDE_DIR turbojpeg.h)
find_library(ImageCodecs_turbojpeg_LIBRARY turbojpeg)
mark_as_advanced(ImageCodecs_turbojpeg_INCLUDE_DIR ImageCodecs_turbojpeg_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(ImageCodecs REQUIRED_VARS
  PNG_FOUND TIFF_FOUND ImageCodecs_turbojpeg_LIBRARY ImageCodecs_turbojpeg_INCLUDE_DIR)
if(ImageCodecs_FOUND AND NOT TARGET ImageCodecs::ImageCodecs)
  add_library(ImageCodecs::ImageCodecs INTERFACE IMPORTED)
  if(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL)
    set_target_properties(ImageCodecs::ImageCodecs PROPERTIES IMPORTED_GLOBAL ON)
  endif()
  target_include_directories(ImageCodecs::ImageCodecs SYSTEM INTERFACE ${ImageCodecs_turbojpeg_INCLUDE_DIR})
  target_link_libraries(ImageCodecs::ImageCodecs INTERFACE PNG::PNG TIFF::TIFF ${ImageCodecs_turbojpeg_LIBRARY})
endif()
