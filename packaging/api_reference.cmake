# SPDX-License-Identifier: Apache-2.0
# The C++ reference of the public headers by Doxygen, not built unless asked for: `make docs`, target kontur_reference.
find_program(KONTUR_DOXYGEN doxygen)
if(NOT KONTUR_DOXYGEN)
  message(STATUS "The C++ reference is left out: doxygen writes it")
  return()
endif()

set(KONTUR_REFERENCE_FOLDER ${PROJECT_BINARY_DIR}/reference)
list(TRANSFORM headers PREPEND "\"${PROJECT_SOURCE_DIR}/src/" OUTPUT_VARIABLE paths)
list(TRANSFORM paths APPEND "\"")
list(JOIN paths " " KONTUR_REFERENCE_INPUT)
configure_file(${PROJECT_SOURCE_DIR}/docs/reference/Doxyfile.in ${CMAKE_CURRENT_BINARY_DIR}/Doxyfile @ONLY)
add_custom_target(kontur_reference
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${KONTUR_REFERENCE_FOLDER}
  COMMAND ${CMAKE_COMMAND} -E make_directory ${KONTUR_REFERENCE_FOLDER}
  COMMAND ${KONTUR_DOXYGEN} ${CMAKE_CURRENT_BINARY_DIR}/Doxyfile
  COMMENT "Writing the C++ reference to ${KONTUR_REFERENCE_FOLDER}/html" VERBATIM)
