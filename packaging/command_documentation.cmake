# SPDX-License-Identifier: Apache-2.0
# Manual pages and shell completions, from the help that the program itself prints.
find_program(KONTUR_PYTHON_FOR_BUILD python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(NOT KONTUR_PYTHON_FOR_BUILD)
  message(STATUS "Manual pages and shell completions are left out: python3 writes them")
  return()
endif()

set(folder ${PROJECT_BINARY_DIR}/command_documentation)
set(scripts document_commands.py command_help.py man_pages.py completions.py)
list(TRANSFORM scripts PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
add_custom_command(
  OUTPUT ${folder}/done
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${folder}
  COMMAND ${KONTUR_PYTHON_FOR_BUILD} -B ${CMAKE_CURRENT_SOURCE_DIR}/document_commands.py $<TARGET_FILE:kontur_app> ${PROJECT_VERSION} ${folder}
  COMMAND ${CMAKE_COMMAND} -E touch ${folder}/done
  DEPENDS kontur_app ${scripts}
  COMMENT "Writing manual pages and shell completions" VERBATIM)
add_custom_target(kontur_command_documentation ALL DEPENDS ${folder}/done)

# Installing only reads: two that install from this build at once get whole files.
install(DIRECTORY ${folder}/compressed/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT command_line)
install(FILES ${folder}/bash/kontur DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT command_line)
install(FILES ${folder}/zsh/_kontur DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT command_line)
install(FILES ${folder}/fish/kontur.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT command_line)
