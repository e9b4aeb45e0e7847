# SPDX-License-Identifier: Apache-2.0
# Writes the files of a folder into a C++ source: cmake -D FOLDER=… -D OUTPUT=… -P embed_page.cmake
# Files come in the order of their names, so the same folder gives the same source.
set(types ".html=text/html; charset=utf-8" ".js=text/javascript; charset=utf-8" ".css=text/css; charset=utf-8"
          ".svg=image/svg+xml" ".png=image/png" ".ico=image/x-icon" ".woff2=font/woff2" ".wasm=application/wasm"
          ".json=application/json" ".txt=text/plain; charset=utf-8")

function(content_type file variable)
  cmake_path(GET file EXTENSION LAST_ONLY suffix)
  foreach(type IN LISTS types)
    if(type MATCHES "^(\\.[a-z0-9]+)=(.*)$" AND CMAKE_MATCH_1 STREQUAL suffix)
      set(${variable} "${CMAKE_MATCH_2}" PARENT_SCOPE)
      return()
    endif()
  endforeach()
  message(FATAL_ERROR "${file}: the server knows no content type of ${suffix}; add it to embed_page.cmake")
endfunction()

file(GLOB_RECURSE files RELATIVE ${FOLDER} ${FOLDER}/*)
list(SORT files)
set(contents "")
set(rows "")
set(number 0)
foreach(file IN LISTS files)
  content_type(${file} type)
  file(READ ${FOLDER}/${file} hex HEX)
  string(REGEX REPLACE "(..)" "\\\\x\\1" bytes "${hex}")
  string(APPEND contents "constexpr std::uint8_t kFile${number}[] = \"${bytes}\";\n")
  string(APPEND rows "    {\"${file}\", \"${type}\", {kFile${number}, sizeof kFile${number} - 1}},\n")
  math(EXPR number "${number} + 1")
endforeach()

file(WRITE ${OUTPUT} "// Made by embed_page.cmake.
#include \"server/web_page.hpp\"

namespace saccade::server {
namespace {

${contents}
constexpr PageFile kPageFiles[] = {
${rows}};

}  // namespace

std::span<const PageFile> page_files() { return kPageFiles; }

}  // namespace saccade::server
")
