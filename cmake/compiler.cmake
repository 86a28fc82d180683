# Before project(), whose own message names no package: is there a C compiler?
if(NOT CMAKE_C_COMPILER AND NOT DEFINED ENV{CC} AND NOT CMAKE_TOOLCHAIN_FILE)
  find_program(SKG_ANY_COMPILER NAMES cc gcc clang icx NO_CACHE)
  if(NOT SKG_ANY_COMPILER)
    message(FATAL_ERROR "Skiagraph needs a C compiler. On Debian or Ubuntu, run as root:\n"
      "    apt-get install gcc libc6-dev make pkg-config\n"
      "Elsewhere, install one, or name it by -DCMAKE_C_COMPILER=.")
  endif()
endif()
