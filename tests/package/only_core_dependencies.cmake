# SPDX-License-Identifier: Apache-2.0
# A dependency provider behind which every package but Eigen, oneTBB and Highway does not exist.
function(saccade_hide_packages method name)
  if(NOT name MATCHES "^(Eigen3|TBB|hwy|HWY|Threads)$")
    message(STATUS "hidden: ${name}")
    set(${name}_FOUND FALSE PARENT_SCOPE)
  else()
    find_package(${name} ${ARGN} BYPASS_PROVIDER)
    set(${name}_FOUND ${${name}_FOUND} PARENT_SCOPE)
  endif()
endfunction()
cmake_language(SET_DEPENDENCY_PROVIDER saccade_hide_packages SUPPORTED_METHODS FIND_PACKAGE)
