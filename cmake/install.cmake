# Library, headers, command, and what pkg-config and find_package(skiagraph) need.
include(CMakePackageConfigHelpers)
install(TARGETS skiagraph EXPORT skiagraph-targets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY lib/include/skiagraph host/include/skiagraph DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(FILES ${skiagraph_BINARY_DIR}/include/skiagraph/version.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/skiagraph)
install(EXPORT skiagraph-targets NAMESPACE skiagraph:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/skiagraph)
configure_package_config_file(cmake/skiagraph-config.cmake.in ${skiagraph_BINARY_DIR}/skiagraph-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/skiagraph)
write_basic_package_version_file(${skiagraph_BINARY_DIR}/skiagraph-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${skiagraph_BINARY_DIR}/skiagraph-config.cmake ${skiagraph_BINARY_DIR}/skiagraph-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/skiagraph)
# Where the prefix is, seen from skiagraph.pc: an installed tree may be moved.
file(RELATIVE_PATH SKG_PREFIX_FROM_PC "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
configure_file(cmake/skiagraph.pc.in ${skiagraph_BINARY_DIR}/skiagraph.pc @ONLY)
install(FILES ${skiagraph_BINARY_DIR}/skiagraph.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
if(TARGET skiagraph_command)
  set_target_properties(skiagraph_command PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
  install(TARGETS skiagraph_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
