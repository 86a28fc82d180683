# The language of every file, and the target skg_flags with its warnings.
set(CMAKE_C_STANDARD 11)
set(CMAKE_C_STANDARD_REQUIRED ON)
set(CMAKE_C_EXTENSIONS OFF)
set(CMAKE_C_VISIBILITY_PRESET hidden)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

# Every file is compiled with the same warnings, and without contraction of a*b+c, which would change results.
add_library(skg_flags INTERFACE)
target_compile_options(skg_flags INTERFACE
  -Wall -Wextra -Wconversion -Wdouble-promotion -Wshadow -Wstrict-prototypes -ffp-contract=off
  $<$<BOOL:${SKG_WERROR}>:-Werror>)
target_compile_definitions(skg_flags INTERFACE $<$<BOOL:${SKG_ASSERTIONS}>:SKG_ASSERTIONS>)
target_compile_definitions(skg_flags INTERFACE _POSIX_C_SOURCE=200809L CL_TARGET_OPENCL_VERSION=120)
if(SKG_FUZZ)
  if(NOT CMAKE_C_COMPILER_ID MATCHES Clang)
    message(FATAL_ERROR "SKG_FUZZ needs clang: cmake -DCMAKE_C_COMPILER=clang-14")
  endif()
  set(SKG_SANITIZE address,undefined,fuzzer-no-link)
  target_compile_options(skg_flags INTERFACE -fno-sanitize-recover=undefined)
endif()
if(SKG_SANITIZE)
  target_compile_options(skg_flags INTERFACE -fsanitize=${SKG_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(skg_flags INTERFACE -fsanitize=${SKG_SANITIZE})
endif()
