# SPDX-License-Identifier: Apache-2.0
# saccade_room(NAME …): one folder of lib/saccade = one library target saccade::NAME = one component of the package.
# saccade_require_rooms(WHO ROOMS…): stops the configuration, naming what is missing, when WHO cannot do without ROOMS.

# Flags of all of Saccade's own code: bit-equal results need FMA contraction off. No code here reads errno or
# floating-point traps; without them loops with square roots and selections become vector code, and every value stays
# equal. On x86-64, SSE4.2 and POPCNT are expected (processors since 2009); kernels choose wider vectors at run time.
string(REGEX MATCH "^(x86_64|AMD64|amd64)$" SACCADE_X86_64 "${CMAKE_SYSTEM_PROCESSOR}")
add_library(saccade_flags INTERFACE)
target_compile_features(saccade_flags INTERFACE cxx_std_20)
target_compile_options(saccade_flags INTERFACE
  $<BUILD_INTERFACE:-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wnon-virtual-dtor -ffp-contract=off
  -fno-math-errno -fno-trapping-math -ffile-prefix-map=${PROJECT_SOURCE_DIR}=.
  $<$<BOOL:${SACCADE_X86_64}>:-march=x86-64-v2>
  $<$<BOOL:${SACCADE_WARNINGS_AS_ERRORS}>:-Werror>>)
if(SACCADE_SANITIZE)
  target_compile_options(saccade_flags INTERFACE $<BUILD_INTERFACE:-fsanitize=${SACCADE_SANITIZE}
                         -fno-sanitize-recover=all -fno-omit-frame-pointer>)
  target_link_options(saccade_flags INTERFACE $<BUILD_INTERFACE:-fsanitize=${SACCADE_SANITIZE}>)
  # With AddressSanitizer Eigen takes its own allocator instead of malloc. That of a program replaces the one in OMPL's
  # library, which still frees by free.
  target_compile_definitions(saccade_flags INTERFACE $<BUILD_INTERFACE:EIGEN_MALLOC_ALREADY_ALIGNED=1>)
  # Kernels for two instruction sets instead of three: the widest differs from AVX2 in nothing but the number of lanes.
  target_compile_definitions(saccade_flags INTERFACE "$<BUILD_INTERFACE:HWY_DISABLED_TARGETS=(HWY_AVX3|HWY_AVX3_DL)>")
  if(SACCADE_SANITIZE MATCHES "thread")
    target_compile_definitions(saccade_flags INTERFACE $<BUILD_INTERFACE:SACCADE_EXECUTOR_STD_THREAD>)
  endif()
endif()

# Rooms that read what others wrote (FUZZED) are searched by libFuzzer, and get all of UBSan. Elsewhere the checks of
# every pointer that is followed cost a third of the compilation, and AddressSanitizer sees most of what they would.
add_library(saccade_fuzzed_flags INTERFACE)
add_library(saccade_unfuzzed_flags INTERFACE)
if(SACCADE_BUILD_FUZZERS)
  target_compile_options(saccade_fuzzed_flags INTERFACE -fsanitize=fuzzer-no-link)
  target_compile_options(saccade_unfuzzed_flags INTERFACE -fno-sanitize=null,alignment,object-size,vptr)
endif()

# What is around the code that is tested is compiled in half of the time or less: the tests themselves (saccade_test_flags),
# and under AddressSanitizer the programs, too (saccade_app_flags). The rooms stay optimised; checks go without UBSan. To be
# linked after saccade_flags, which this overrides. (Under ThreadSanitizer the slow references of tests need it all.)
add_library(saccade_app_flags INTERFACE)
add_library(saccade_test_flags INTERFACE)
if(SACCADE_SANITIZE MATCHES "address")
  target_compile_options(saccade_app_flags INTERFACE -O0)
  target_compile_options(saccade_test_flags INTERFACE -O0 $<$<CXX_COMPILER_ID:Clang>:-fno-sanitize=undefined>)
elseif(NOT SACCADE_SANITIZE)
  target_compile_options(saccade_test_flags INTERFACE $<$<CONFIG:Release>:-O1>)
endif()

# saccade_rooms_first(TARGET ROOMS…): of a function that several objects contain (a template, say) the linker keeps the first.
# Under AddressSanitizer, those of the rooms come first, so that they are the optimised ones.
function(saccade_rooms_first target)
  if(NOT SACCADE_SANITIZE MATCHES "address" OR NOT ARGN)
    return()
  endif()
  set(rooms ${ARGN})
  set(open ${ARGN})
  while(open)
    list(POP_FRONT open room)
    get_property(below GLOBAL PROPERTY SACCADE_ROOM_${room}_ROOMS)
    list(REMOVE_ITEM below ${rooms})
    list(APPEND rooms ${below})
    list(APPEND open ${below})
  endwhile()
  list(TRANSFORM rooms REPLACE "(.+)" "$<TARGET_FILE:saccade::\\1>")
  list(JOIN rooms "," archives)
  target_link_options(${target} PRIVATE "LINKER:--whole-archive,${archives},--no-whole-archive")
endfunction()

# saccade_room(NAME SOURCES file… [ROOMS room…] [PACKAGES "name arguments of find_package"…]
#              [PUBLIC target…] [PRIVATE target…] [FUZZED] [FUZZED_SOURCES file…])
# The folder of a room is lib/saccade/NAME, or lib/saccade/io/clouds for io_clouds.
# ROOMS are the rooms that this one includes; the layer test holds them to the order of the layers. PACKAGES are what the
# targets in PUBLIC and PRIVATE come from; the installed package looks for the same ones, for this component only.
# A room whose packages or rooms are not there is left out of the build, with a line that says why.
function(saccade_room name)
  cmake_parse_arguments(ROOM "FUZZED" "" "SOURCES;ROOMS;PACKAGES;PUBLIC;PRIVATE;FUZZED_SOURCES" ${ARGN})
  if(ROOM_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "saccade_room(${name}): unknown arguments ${ROOM_UNPARSED_ARGUMENTS}")
  endif()
  set(missing "")
  foreach(room IN LISTS ROOM_ROOMS)
    if(NOT TARGET saccade::${room})
      list(APPEND missing "room ${room}")
    endif()
  endforeach()
  set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)
  foreach(package IN LISTS ROOM_PACKAGES)
    separate_arguments(arguments UNIX_COMMAND "${package}")
    list(POP_FRONT arguments package_name)
    find_package(${package_name} ${arguments} QUIET)
    if(NOT ${package_name}_FOUND)
      list(APPEND missing "${package}")
    endif()
  endforeach()
  if(missing)
    list(JOIN missing ", " missing)
    message(STATUS "Saccade: room ${name} is left out, for lack of: ${missing}")
    set_property(GLOBAL PROPERTY SACCADE_ROOM_${name}_LACKS "${missing}")
    set_property(GLOBAL APPEND PROPERTY SACCADE_ROOMS_LEFT_OUT ${name})
    return()
  endif()

  set(target saccade_${name})
  add_library(${target} STATIC ${ROOM_SOURCES})
  foreach(source IN LISTS ROOM_SOURCES)  # Highway reads vector kernels once per instruction set, as files of their own
    file(STRINGS ${source} kernels REGEX "HWY_TARGET_INCLUDE")
    if(kernels)
      set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
  endforeach()
  add_library(saccade::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  if(NOT PROJECT_IS_TOP_LEVEL AND NOT SACCADE_INSTALL)  # a subproject compiles only what a program links
    set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL ON)
  endif()
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/lib> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  list(TRANSFORM ROOM_ROOMS PREPEND saccade:: OUTPUT_VARIABLE room_targets)
  set(room_flags saccade_unfuzzed_flags)
  if(ROOM_FUZZED)
    set(room_flags saccade_fuzzed_flags)
  endif()
  target_link_libraries(${target} PUBLIC ${room_targets} ${ROOM_PUBLIC}
                        PRIVATE $<BUILD_INTERFACE:saccade_flags> $<BUILD_INTERFACE:${room_flags}> ${ROOM_PRIVATE})
  if(SACCADE_BUILD_FUZZERS AND ROOM_FUZZED_SOURCES)  # as FUZZED, for some files of a room
    set_source_files_properties(${ROOM_FUZZED_SOURCES} PROPERTIES
      COMPILE_OPTIONS "-fsanitize=fuzzer-no-link;-fsanitize=null,alignment,object-size,vptr")
  endif()
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR}/lib/saccade ${CMAKE_CURRENT_SOURCE_DIR})
  set_property(GLOBAL APPEND PROPERTY SACCADE_ROOMS ${name})
  set_property(GLOBAL PROPERTY SACCADE_ROOM_${name}_FOLDER "${folder}")
  set_property(GLOBAL PROPERTY SACCADE_ROOM_${name}_ROOMS "${ROOM_ROOMS}")
  set_property(GLOBAL PROPERTY SACCADE_ROOM_${name}_PACKAGES "${ROOM_PACKAGES}")
  if(SACCADE_INSTALL)
    install(TARGETS ${target} EXPORT saccade_${name} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
    install(EXPORT saccade_${name} NAMESPACE saccade:: FILE saccade-${name}-targets.cmake
            DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/saccade COMPONENT development)
    install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/saccade/${folder}
            COMPONENT development FILES_MATCHING PATTERN "*.hpp" PATTERN "internal" EXCLUDE)
  endif()
endfunction()

function(saccade_require_rooms who)
  foreach(room IN LISTS ARGN)
    if(NOT TARGET saccade::${room})
      get_property(lacks GLOBAL PROPERTY SACCADE_ROOM_${room}_LACKS)
      message(FATAL_ERROR "${who} needs the room ${room}, which lacks: ${lacks}. "
                          "Install the packages named in packages.txt (scripts/install_packages.sh program), "
                          "or configure with -DSACCADE_BUILD_APPS=OFF -DSACCADE_BUILD_TESTS=OFF.")
    endif()
  endforeach()
endfunction()
