# SPDX-License-Identifier: Apache-2.0
# saccade_room(NAME SOURCES … HEADERS … ROOMS … PUBLIC … PRIVATE …): one folder of lib/saccade = one library target.

# Flags of all of Saccade's own code: bit-equal results need FMA contraction off.
add_library(saccade_flags INTERFACE)
target_compile_features(saccade_flags INTERFACE cxx_std_20)
target_compile_options(saccade_flags INTERFACE
  $<BUILD_INTERFACE:-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wnon-virtual-dtor -ffp-contract=off
  $<$<BOOL:${SACCADE_WARNINGS_AS_ERRORS}>:-Werror>>)
if(SACCADE_SANITIZE)
  target_compile_options(saccade_flags INTERFACE $<BUILD_INTERFACE:-fsanitize=${SACCADE_SANITIZE}
                         -fno-sanitize-recover=all -fno-omit-frame-pointer>)
  target_link_options(saccade_flags INTERFACE $<BUILD_INTERFACE:-fsanitize=${SACCADE_SANITIZE}>)
  if(SACCADE_SANITIZE MATCHES "thread")
    target_compile_definitions(saccade_flags INTERFACE $<BUILD_INTERFACE:SACCADE_EXECUTOR_STD_THREAD>)
  endif()
endif()

function(saccade_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;ROOMS;PUBLIC;PRIVATE" ${ARGN})
  set(target saccade_${name})
  add_library(${target} STATIC ${ROOM_SOURCES})
  add_library(saccade::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/lib> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  list(TRANSFORM ROOM_ROOMS PREPEND saccade::)
  target_link_libraries(${target} PUBLIC ${ROOM_ROOMS} ${ROOM_PUBLIC}
                        PRIVATE $<BUILD_INTERFACE:saccade_flags> ${ROOM_PRIVATE})
  set_property(GLOBAL APPEND PROPERTY SACCADE_ROOMS ${name})
endfunction()
