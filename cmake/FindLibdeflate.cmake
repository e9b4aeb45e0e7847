# SPDX-License-Identifier: Apache-2.0
# Libdeflate::Libdeflate: its CRC-32 is that of saved maps. Headers are system headers.
find_path(Libdeflate_INCLUDE_DIR libdeflate.h)
find_library(Libdeflate_LIBRARY deflate)
mark_as_advanced(Libdeflate_INCLUDE_DIR Libdeflate_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Libdeflate REQUIRED_VARS Libdeflate_LIBRARY Libdeflate_INCLUDE_DIR)
if(Libdeflate_FOUND AND NOT TARGET Libdeflate::Libdeflate)
  add_library(Libdeflate::Libdeflate INTERFACE IMPORTED)
  if(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL)
    set_target_properties(Libdeflate::Libdeflate PROPERTIES IMPORTED_GLOBAL ON)
  endif()
  target_include_directories(Libdeflate::Libdeflate SYSTEM INTERFACE ${Libdeflate_INCLUDE_DIR})
  target_link_libraries(Libdeflate::Libdeflate INTERFACE ${Libdeflate_LIBRARY})
endif()
