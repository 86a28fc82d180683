# Materials, beams and detector responses.
skg_test(element_test material/element_test.c)
target_compile_definitions(element_test PRIVATE SKG_SOURCE="${CMAKE_SOURCE_DIR}")
target_sources(element_test PRIVATE ${CMAKE_SOURCE_DIR}/materials/spline.c)
pkg_check_modules(XRAYLIB IMPORTED_TARGET libxrl)
if(XRAYLIB_FOUND) # an independent table, for this test only
  skg_test(xraylib_test material/xraylib_test.c)
  target_link_libraries(xraylib_test PRIVATE PkgConfig::XRAYLIB)
endif()
skg_public_test(material_test material/material_test.c)
skg_public_test(tube_test beam/tube_test.c)
target_compile_definitions(tube_test PRIVATE SKG_SOURCE="${CMAKE_SOURCE_DIR}")
skg_public_test(spectrum_test beam/spectrum_test.c)
target_compile_definitions(spectrum_test PRIVATE SKG_SOURCE="${CMAKE_SOURCE_DIR}")
