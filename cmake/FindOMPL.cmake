# SPDX-License-Identifier: Apache-2.0
# OMPL::ompl. OMPL's own package file has no target, and links what only its extensions need.
find_path(OMPL_INCLUDE_DIR ompl/base/StateSpace.h PATH_SUFFIXES ompl-1.6 ompl-1.5)
find_library(OMPL_LIBRARY ompl)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OMPL REQUIRED_VARS OMPL_LIBRARY OMPL_INCLUDE_DIR)
if(OMPL_FOUND AND NOT TARGET OMPL::ompl)
  add_library(OMPL::ompl SHARED IMPORTED)
  set_target_properties(OMPL::ompl PROPERTIES IMPORTED_LOCATION "${OMPL_LIBRARY}"
                        INTERFACE_INCLUDE_DIRECTORIES "${OMPL_INCLUDE_DIR}")
endif()
mark_as_advanced(OMPL_INCLUDE_DIR OMPL_LIBRARY)
