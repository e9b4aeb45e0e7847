# SPDX-License-Identifier: Apache-2.0
# CPack runs this when the files of all packages are in place, and packs them afterwards.
execute_process(COMMAND /usr/bin/python3 -B ${CMAKE_CURRENT_LIST_DIR}/../packaging/stage.py ${CPACK_TEMPORARY_DIRECTORY}
                        ${CPACK_PACKAGE_VERSION} "${CPACK_PACKAGE_CONTACT}" ${CPACK_PACKAGE_DIRECTORY}/..
                COMMAND_ERROR_IS_FATAL ANY)
