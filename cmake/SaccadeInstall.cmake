# SPDX-License-Identifier: Apache-2.0
# The exported package: find_package(saccade COMPONENTS core map view), a component per room.
include(CMakePackageConfigHelpers)

set(destination ${CMAKE_INSTALL_LIBDIR}/cmake/saccade)
get_property(SACCADE_PACKAGE_ROOMS GLOBAL PROPERTY SACCADE_ROOMS)
set(SACCADE_PACKAGE_TABLE "")
foreach(room IN LISTS SACCADE_PACKAGE_ROOMS)
  get_property(rooms GLOBAL PROPERTY SACCADE_ROOM_${room}_ROOMS)
  get_property(packages GLOBAL PROPERTY SACCADE_ROOM_${room}_PACKAGES)
  string(APPEND SACCADE_PACKAGE_TABLE "set(_saccade_rooms_of_${room} \"${rooms}\")\n"
                                      "set(_saccade_packages_of_${room} \"${packages}\")\n")
endforeach()
get_property(left_out GLOBAL PROPERTY SACCADE_ROOMS_LEFT_OUT)
foreach(room IN LISTS left_out)
  get_property(lacks GLOBAL PROPERTY SACCADE_ROOM_${room}_LACKS)
  string(APPEND SACCADE_PACKAGE_TABLE "set(_saccade_lacks_of_${room} \"${lacks}\")\n")
endforeach()

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/saccadeConfig.cmake.in
  ${PROJECT_BINARY_DIR}/package/saccadeConfig.cmake INSTALL_DESTINATION ${destination})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/saccadeConfigVersion.cmake
  VERSION ${PROJECT_VERSION} COMPATIBILITY SameMinorVersion)
file(GLOB find_modules ${CMAKE_CURRENT_LIST_DIR}/Find*.cmake)
install(FILES ${PROJECT_BINARY_DIR}/package/saccadeConfig.cmake
              ${PROJECT_BINARY_DIR}/package/saccadeConfigVersion.cmake
              ${find_modules}
        DESTINATION ${destination} COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT license)  # a .deb has it as copyright
