# Install rules: library, public headers, tool and the package config for find_package(nonobtuse).
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/nonobtuse)

install(TARGETS nonobtuse EXPORT nonobtuseTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(FILES ${NONOBTUSE_HEADERS} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/nonobtuse)
install(EXPORT nonobtuseTargets NAMESPACE nonobtuse:: DESTINATION ${package_dir})
install(FILES LICENSE CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})

configure_package_config_file(cmake/nonobtuseConfig.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/nonobtuseConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/nonobtuseConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${CMAKE_CURRENT_BINARY_DIR}/nonobtuseConfig.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/nonobtuseConfigVersion.cmake
  DESTINATION ${package_dir})

if(TARGET nonobtuse-tool)
  install(TARGETS nonobtuse-tool RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
