# SPDX-License-Identifier: Apache-2.0
# Debian packages by CPack, one per component of the install rules: make package (scripts/package.sh).
#   program → saccade    development → libsaccade-dev    python → python3-saccade    ros1, ros2 → saccade-ros1, saccade-ros2
# package_stage.cmake finishes the files before they are packed; dpkg-shlibdeps finds the libraries that programs link.
install(FILES packaging/saccade.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
install(FILES packaging/saccade-mime.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages RENAME saccade.xml)
install(FILES web/dist/assets/icon.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps RENAME saccade.svg)
set(documentation ${CMAKE_INSTALL_DATADIR}/doc/saccade)
install(FILES README.md CITATION.cff DESTINATION ${documentation})
install(DIRECTORY docs/ DESTINATION ${documentation}/docs PATTERN api.txt EXCLUDE)
file(GLOB device_programs ${PROJECT_SOURCE_DIR}/devices/*.py)
install(FILES ${device_programs} DESTINATION ${documentation}/examples/devices)
install(DIRECTORY examples/cell robots scenes DESTINATION ${documentation}/examples PATTERN README.md EXCLUDE)
file(GLOB example_programs ${PROJECT_SOURCE_DIR}/examples/*.cpp)
install(FILES ${example_programs} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libsaccade-dev/examples COMPONENT development)
install(FILES docs/reference/api.txt docs/reference/moved-headers.md
        DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libsaccade-dev COMPONENT development)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME saccade)
set(CPACK_PACKAGE_VENDOR "The Saccade authors")
set(SACCADE_PACKAGE_CONTACT "The Saccade authors <saccade@saccade.invalid>" CACHE STRING "Maintainer of the Debian packages")
set(CPACK_PACKAGE_CONTACT ${SACCADE_PACKAGE_CONTACT})
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
                                                WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/package_stage.cmake)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# saccade_package(COMPONENT NAME SYNOPSIS DESCRIPTION [DEPENDS …] [SETTINGS KEY VALUE…]): KEY is one of CPack's
# CPACK_DEBIAN_<COMPONENT>_PACKAGE_KEY. A macro, since CPack reads the variables of this file.
macro(saccade_package component name synopsis description)
  string(TOUPPER ${component} upper)
  set(settings ${ARGN})
  while(settings)
    list(POP_FRONT settings key value)
    set(CPACK_DEBIAN_${upper}_PACKAGE_${key} ${value})
  endwhile()
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  install(FILES packaging/debian/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component})
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${synopsis}\n${description}")
  if(NOT ${component} STREQUAL development)
    set(CPACK_DEBIAN_${upper}_PACKAGE_SHLIBDEPS ON)
  endif()
endmacro()

set(same_version "saccade (= ${PROJECT_VERSION})")
set(about "Saccade decides where a robot-held depth camera should look next, and
builds the 3-D model as it goes: TSDF mapping, view evaluation, attention,
arms that plan, segmentation, surfels and annotation.\n\nThis package has")
set(CPACK_COMPONENTS_ALL "")
saccade_package(program saccade "next-best-view planning with a robot-held depth camera"
  "${about} the program, the programs of cameras and simulated\ndevices, and the documentation.")

# Headers of other libraries that those of Saccade include. The core rooms cannot do without theirs.
set(core_packages libeigen3-dev libtbb-dev libhwy-dev libzstd-dev)
set(other_packages "")
file(STRINGS ${PROJECT_SOURCE_DIR}/packages.txt lines)
set(inside "")
string(REPLACE "[" "section " lines "${lines}")  # lone brackets would join the elements of the list
string(REPLACE "]" " " lines "${lines}")
foreach(line IN LISTS lines)
  string(REGEX MATCH "^[a-z0-9.+-]+" word "${line}")
  if(word STREQUAL "section")
    string(REGEX MATCH "^section program " inside "${line}")
  elseif(inside AND word MATCHES "-dev$" AND NOT word IN_LIST core_packages AND NOT word MATCHES "cli11|boost")
    list(APPEND other_packages ${word})  # CLI11 and Boost are the program's
  endif()
endforeach()
list(JOIN core_packages ", " core_packages)
list(JOIN other_packages ", " other_packages)
saccade_package(development libsaccade-dev "next-best-view planning with a depth camera (C++ library)"
  "${about} the headers, the static libraries and what\nfind_package(saccade) of CMake reads."
  SECTION libdevel DEPENDS "${core_packages}" RECOMMENDS "${other_packages}, cmake, pkgconf" SUGGESTS "${same_version}")

# Python's files are compiled when they are installed, and what was compiled goes with them.
set(scripts ${PROJECT_BINARY_DIR}/packaging)
foreach(package python3-saccade saccade-ros1)
  configure_file(packaging/debian/postinst.in ${scripts}/${package}/postinst @ONLY FILE_PERMISSIONS
                 OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  configure_file(packaging/debian/prerm.in ${scripts}/${package}/prerm @ONLY FILE_PERMISSIONS
                 OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
endforeach()
if(TARGET saccade_python)
  math(EXPR next_minor "${SACCADE_MODULE_PYTHON_MINOR} + 1")
  saccade_package(python python3-saccade "next-best-view planning with a depth camera (Python 3)"
    "${about} the module saccade. python3 -m saccade is the\nprogram."
    SECTION python RECOMMENDS "${same_version}"
    DEPENDS "python3 (>= 3.${SACCADE_MODULE_PYTHON_MINOR}), python3 (<< 3.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${scripts}/python3-saccade/postinst ${scripts}/python3-saccade/prerm)
endif()
if(TARGET saccade-ros1)
  saccade_package(ros1 saccade-ros1 "next-best-view planning with a depth camera (ROS 1)"
    "${about} the nodes for ROS 1, their messages and launch files."
    DEPENDS "${same_version}, python3, python3-genpy")
  set(CPACK_DEBIAN_ROS1_PACKAGE_CONTROL_EXTRA ${scripts}/saccade-ros1/postinst ${scripts}/saccade-ros1/prerm)
endif()
if(TARGET saccade-ros2)
  saccade_package(ros2 saccade-ros2 "next-best-view planning with a depth camera (ROS 2)"
    "${about} the program that speaks with robots of ROS 2 over\nDDS. It needs no ROS."
    DEPENDS "${same_version}")
endif()
include(CPack)
