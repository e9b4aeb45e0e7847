# SPDX-License-Identifier: Apache-2.0
# cmake -D PTX=… -D TARGET=… -D TEMPLATE=… -D OUT=… -P embed_ptx.cmake: writes a source file with the text of the kernels.
file(READ ${PTX} PTX_TEXT)
set(PTX_TARGET ${TARGET})
configure_file(${TEMPLATE} ${OUT} @ONLY)
