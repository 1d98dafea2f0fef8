# What is installed, in two components: lodestar (the program and what belongs to it), and development (headers, static
# libraries, find_package(Lodestar)). cmake/package.cmake makes a Debian package of each.

set(lodestar_docs ${CMAKE_INSTALL_DATADIR}/doc)

# Manual pages and completions, written by the program from its own command line.
set(command_line_files ${CMAKE_BINARY_DIR}/command_line)
add_custom_command(OUTPUT ${command_line_files}/written
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${command_line_files}
  COMMAND lodestar command-line ${command_line_files}
  COMMAND find ${command_line_files}/man -name *.1 -exec gzip -9n {} +
  COMMAND ${CMAKE_COMMAND} -E touch ${command_line_files}/written
  DEPENDS lodestar
  COMMENT "Writing manual pages and completions" VERBATIM)
add_custom_target(lodestar_command_line ALL DEPENDS ${command_line_files}/written)

install(TARGETS lodestar RUNTIME COMPONENT lodestar)
install(DIRECTORY sites/lab DESTINATION ${CMAKE_INSTALL_DATADIR}/lodestar/sites COMPONENT lodestar
  PATTERN state.yaml EXCLUDE PATTERN .history EXCLUDE)
install(DIRECTORY faults scenarios DESTINATION ${CMAKE_INSTALL_DATADIR}/lodestar COMPONENT lodestar)
install(FILES ${CMAKE_BINARY_DIR}/share/lodestar/commit DESTINATION ${CMAKE_INSTALL_DATADIR}/lodestar COMPONENT lodestar)
install(DIRECTORY ${command_line_files}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT lodestar)
install(DIRECTORY ${command_line_files}/bash-completion ${command_line_files}/zsh
  DESTINATION ${CMAKE_INSTALL_DATADIR} COMPONENT lodestar)
install(FILES packaging/lodestar@.service DESTINATION lib/systemd/system COMPONENT lodestar)
install(FILES packaging/lodestar.tmpfiles DESTINATION lib/tmpfiles.d COMPONENT lodestar RENAME lodestar.conf)
install(FILES packaging/70-lodestar.rules DESTINATION lib/udev/rules.d COMPONENT lodestar)

# The rooms of which the development package has headers and libraries; localization is those below it, and maps is
# under all.
set(localization_rooms detection pose ceiling filter scan integrity calibration survey)
add_library(lodestar_localization INTERFACE)
foreach(room IN LISTS localization_rooms)
  target_link_libraries(lodestar_localization INTERFACE lodestar_${room})
endforeach()
foreach(room IN ITEMS properties maps planning control localization ${localization_rooms})
  set_target_properties(lodestar_${room} PROPERTIES EXPORT_NAME ${room})
  install(TARGETS lodestar_${room} EXPORT LodestarTargets ARCHIVE COMPONENT development)
endforeach()
install(DIRECTORY maps localization planning control DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lodestar
  COMPONENT development FILES_MATCHING PATTERN *.hpp)

include(CMakePackageConfigHelpers)
set(lodestar_cmake ${CMAKE_INSTALL_LIBDIR}/cmake/Lodestar)
# Versions are semantic; before 1.0 a minor version may change what the one before promised.
write_basic_package_version_file(${CMAKE_BINARY_DIR}/LodestarConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT LodestarTargets NAMESPACE Lodestar:: DESTINATION ${lodestar_cmake} COMPONENT development)
install(FILES ${CMAKE_BINARY_DIR}/LodestarConfigVersion.cmake cmake/LodestarConfig.cmake cmake/opencv.cmake
  DESTINATION ${lodestar_cmake} COMPONENT development)
install(DIRECTORY examples DESTINATION ${lodestar_docs}/liblodestar-dev COMPONENT development)
