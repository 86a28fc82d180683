# Library, headers, command, and what pkg-config and find_package(skiagraph) need. Components are those of the packages
# (packaging.cmake): what is not said here belongs to dev.
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME dev)
set(cmake_files ${CMAKE_INSTALL_LIBDIR}/cmake/skiagraph)
install(TARGETS skiagraph EXPORT skiagraph-targets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  COMPONENT library NAMELINK_COMPONENT dev)
install(FILES LICENSE CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT library)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(EXPORT skiagraph-targets NAMESPACE skiagraph:: DESTINATION ${cmake_files})
if(SKG_STATIC)
  install(TARGETS skiagraph_static EXPORT skiagraph-static-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT skiagraph-static-targets NAMESPACE skiagraph:: DESTINATION ${cmake_files})
endif()
install(DIRECTORY lib/include/skiagraph host/include/skiagraph DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.h" PATTERN "*.hpp")
install(FILES ${skiagraph_BINARY_DIR}/include/skiagraph/version.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/skiagraph)
configure_package_config_file(cmake/skiagraph-config.cmake.in ${skiagraph_BINARY_DIR}/skiagraph-config.cmake
  INSTALL_DESTINATION ${cmake_files})
write_basic_package_version_file(${skiagraph_BINARY_DIR}/skiagraph-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${skiagraph_BINARY_DIR}/skiagraph-config.cmake ${skiagraph_BINARY_DIR}/skiagraph-config-version.cmake
  DESTINATION ${cmake_files})

# The .pc files find the prefix from their own place: an installed tree may be moved.
file(RELATIVE_PATH SKG_PREFIX_FROM_PC "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
# Libraries that a static program links besides, by -l: Requires.private would ask for these libraries' .pc files from programs
# that link the shared library, too.
set(SKG_LIBS_PRIVATE ${ASSIMP_LDFLAGS} ${JANSSON_LDFLAGS} ${PNG_LDFLAGS} ${ZLIB_LDFLAGS} ${TIFF_LDFLAGS} ${ZIP_LDFLAGS} ${MD_LDFLAGS} ${HDF5_LDFLAGS} ${OPENCL_LDFLAGS})
list(TRANSFORM OpenMP_C_LIB_NAMES PREPEND -l OUTPUT_VARIABLE openmp)
list(TRANSFORM CMAKE_DL_LIBS PREPEND -l OUTPUT_VARIABLE dl)
list(APPEND SKG_LIBS_PRIVATE ${openmp} -lm ${dl})
list(REMOVE_DUPLICATES SKG_LIBS_PRIVATE)
list(JOIN SKG_LIBS_PRIVATE " " SKG_LIBS_PRIVATE)
foreach(name skiagraph skiagraph-opencl)
  configure_file(cmake/${name}.pc.in ${skiagraph_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${skiagraph_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()
if(TARGET skiagraph_command)
  set_target_properties(skiagraph_command PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR};$ORIGIN/../lib")
  install(TARGETS skiagraph_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command)
endif()
