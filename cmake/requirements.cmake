# Finds the packages that Skiagraph needs. All that are missing are named in one message, by the packages of Debian that have them.
set(SKG_MISSING "")
find_package(OpenMP COMPONENTS C)
if(NOT OpenMP_C_FOUND)
  if(CMAKE_C_COMPILER_ID MATCHES Clang)
    list(APPEND SKG_MISSING libomp-dev)
  else()
    list(APPEND SKG_MISSING gcc)
  endif()
endif()
find_package(PkgConfig)
if(NOT PKG_CONFIG_FOUND)
  list(APPEND SKG_MISSING pkg-config)
endif()

# skg_require(PREFIX "MODULE..." PACKAGE...): the target PkgConfig::PREFIX of these modules. A macro, because
# pkg_check_modules sets variables.
macro(skg_require prefix modules)
  if(PKG_CONFIG_FOUND)
    pkg_check_modules(${prefix} IMPORTED_TARGET ${modules})
  endif()
  if(NOT ${prefix}_FOUND)
    list(APPEND SKG_MISSING ${ARGN})
  endif()
endmacro()
skg_require(OPENCL OpenCL ocl-icd-opencl-dev opencl-headers)
skg_require(CGLM cglm libcglm-dev) # headers only
skg_require(ASSIMP assimp libassimp-dev)
skg_require(JANSSON jansson libjansson-dev)
skg_require(PNG libpng libpng-dev)
skg_require(ZLIB zlib zlib1g-dev) # libpng needs it, too
skg_require(TIFF libtiff-4>=4.5 libtiff-dev)
skg_require(ZIP libzip libzip-dev) # 3MF
skg_require(MD libmd libmd-dev) # SHA-256
if(SKG_BUILD_COMMAND OR SKG_BUILD_DOCS)
  skg_require(CAIRO "cairo;cairo-svg;cairo-png" libcairo2-dev) # plots of `material` and `beam`
endif()
if(BUILD_TESTING AND PROJECT_IS_TOP_LEVEL)
  skg_require(CHECK check check)
endif()
if(SKG_MISSING)
  list(JOIN SKG_MISSING " " packages)
  message(FATAL_ERROR "Skiagraph cannot be built: libraries, headers or tools are missing. On Debian or Ubuntu, run as root:\n"
    "    apt-get install ${packages}\n"
    "Elsewhere, install what these packages are called there. -DBUILD_TESTING=OFF needs no Check, "
    "-DSKG_BUILD_COMMAND=OFF no Cairo.")
endif()
pkg_search_module(HDF5 IMPORTED_TARGET hdf5-serial hdf5) # scans as .h5
