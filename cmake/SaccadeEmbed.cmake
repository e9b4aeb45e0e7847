# SPDX-License-Identifier: Apache-2.0
# saccade_embed_folder(FOLDER EXTENSION): makes builtin_FOLDER.cpp in the build folder from its .in file, with the name and
# the text of each file of FOLDER.
function(saccade_embed_folder folder extension)
  file(GLOB files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.${extension})
  set(BUILTIN_FILES "")
  foreach(file IN LISTS files)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    get_filename_component(name ${file} NAME_WE)
    file(READ ${file} text)
    string(APPEND BUILTIN_FILES "      {\"${name}\", R\"${extension}(${text})${extension}\"},\n")
  endforeach()
  configure_file(builtin_${folder}.cpp.in builtin_${folder}.cpp @ONLY)
endfunction()
