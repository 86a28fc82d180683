# cpack reads this first.
if(CPACK_GENERATOR STREQUAL DEB AND NOT CPACK_SKG_LIBDIR STREQUAL CPACK_SKG_DEBIAN_LIBDIR)
  message(FATAL_ERROR "This build folder installs libraries in ${CPACK_SKG_LIBDIR}, Debian in ${CPACK_SKG_DEBIAN_LIBDIR}: "
    "configure with `cmake --preset debian`, build, and run cpack in build-debian.")
endif()
