# cmake --install: the program with its studies, man page and completions (component program), and the libraries of uq and
# surrogate with headers and a package config (component development). cpack -G DEB makes a Debian package of each.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS demcal RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
set(without_studies)
foreach(study developer quick other-code drum-table drum-mcc hydrogel paper)
  install(DIRECTORY data/${study} DESTINATION ${CMAKE_INSTALL_DATADIR}/demcal/data COMPONENT program)
  list(APPEND without_studies PATTERN ${study} EXCLUDE)
endforeach()
install(FILES README.md docs/keys.md docs/files.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT program)

# Written by the program itself, from its commands and keys.
set(written)
foreach(one "man:demcal.1" "bash:demcal.bash" "zsh:_demcal")
  string(REPLACE ":" ";" one ${one})
  list(GET one 0 kind)
  list(GET one 1 name)
  add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/reference/${name}
                     COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_BINARY_DIR}/reference
                     COMMAND demcal help --as ${kind} > ${CMAKE_BINARY_DIR}/reference/${name}
                     DEPENDS demcal VERBATIM)
  list(APPEND written ${CMAKE_BINARY_DIR}/reference/${name})
endforeach()
add_custom_target(reference ALL DEPENDS ${written})
install(FILES ${CMAKE_BINARY_DIR}/reference/demcal.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${CMAKE_BINARY_DIR}/reference/demcal.bash RENAME demcal
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
install(FILES ${CMAKE_BINARY_DIR}/reference/_demcal DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions
        COMPONENT program)

# All of uq.
add_library(demcal_uq INTERFACE)
target_link_libraries(demcal_uq INTERFACE demcal_plan demcal_report)
install(TARGETS demcal_flags demcal_isa demcal_uq demcal_data demcal_surrogate demcal_infer demcal_findings demcal_emulate
                demcal_posterior demcal_verdict demcal_refine demcal_calibrate demcal_plan demcal_report
        EXPORT demcal ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
foreach(folder data surrogate uq)
  install(DIRECTORY ${folder}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/demcal/${folder} COMPONENT development
          FILES_MATCHING PATTERN "*.hpp" ${without_studies})
endforeach()
set(config ${CMAKE_INSTALL_LIBDIR}/cmake/demcal)
install(EXPORT demcal NAMESPACE demcal:: DESTINATION ${config} COMPONENT development)
configure_package_config_file(cmake/demcal-config.cmake.in ${CMAKE_BINARY_DIR}/demcal-config.cmake
                              INSTALL_DESTINATION ${config})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/demcal-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/demcal-config.cmake ${CMAKE_BINARY_DIR}/demcal-config-version.cmake
        DESTINATION ${config} COMPONENT development)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "the demcal developers <demcal@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "calibrates a discrete element model of a powder against measured torque")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME demcal)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS gnuplot-nox)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS povray)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libdemcal-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev, libfmt-dev, libtomlplusplus-dev, nlohmann-json3-dev, \
libgsl-dev, libnlopt-dev, libhdf5-dev, libnetcdf-dev, libxxhash-dev, libudunits2-dev")
include(CPack)
