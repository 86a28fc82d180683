#!/bin/sh
# The installed tree that run.sh left behind, used from another language. usage:
# language.sh fortran|cpp|mpi|python SOURCE BUILD PYTHON
set -eu
source=$2
stage=$3/package-test
lib=$(dirname "$(find "$stage/usr" -name 'libskiagraph.so')")
export PKG_CONFIG_PATH="$lib/pkgconfig" LD_LIBRARY_PATH="$lib"
cd "$stage/work"
need() {
    command -v "$1" >/dev/null 2>&1 && return
    echo "skipped: no $1"
    exit 77
}
case $1 in
fortran)
    need gfortran
    module=$(pkg-config --variable=fortran skiagraph)
    if [ ! -e "$module" ]; then
        echo "skipped: no Python made the module when this build was configured"
        exit 77
    fi
    for program in "$3/fortran/every_call" "$source/examples/first_image" "$source/examples/thousand_images"; do
        name=$(basename "$program")_f
        # shellcheck disable=SC2046
        gfortran -std=f2018 -Wall -Wno-unused-dummy-argument "$module" "$program.f90" $(pkg-config --libs skiagraph) -o "$name"
    done
    ./every_call_f
    gfortran -fc-prototypes -fsyntax-only -J. "$module" >prototypes.h
    "$4" "$source/tests/package/fortran_signatures.py" "$source/lib/bindings/interface.json" "$module" prototypes.h
    ./first_image_f
    sed 's/"NumberOfPixels": *\[[^]]*\]/"NumberOfPixels": [64, 64]/' "$source/examples/scenes/phantom.json" >small.json
    ./thousand_images_f small.json marker
    ;;
cpp)
    need g++
    # shellcheck disable=SC2046
    g++ -std=c++20 -Wall -Wextra -Wpedantic -Werror "$source/examples/first_image.cpp" $(pkg-config --cflags --libs skiagraph) \
        -o first_image_cpp
    ./first_image_cpp
    echo '#include <skiagraph/skiagraph.hpp>' >old.cpp
    # shellcheck disable=SC2046
    if g++ -std=c++17 -fsyntax-only old.cpp $(pkg-config --cflags skiagraph) 2>old.log; then
        echo "skiagraph.hpp compiles as C++17"
        exit 1
    fi
    grep -q 'needs C++20' old.log
    if command -v cmake >/dev/null 2>&1; then
        mkdir -p cpp
        cp "$source/examples/first_image.cpp" cpp/
        # No standard is set: the target asks for its own.
        cat >cpp/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.21)
project(first_image CXX)
find_package(skiagraph REQUIRED)
add_executable(first_image first_image.cpp)
target_link_libraries(first_image PRIVATE skiagraph::skiagraph)
END
        cmake -S cpp -B cpp/build "-Dskiagraph_DIR=$lib/cmake/skiagraph" >cpp.log
        cmake --build cpp/build >>cpp.log
        cpp/build/first_image
    fi
    ;;
mpi)
    need mpicc
    need mpirun
    # shellcheck disable=SC2046
    mpicc -std=c11 -Wall -Wextra "$source/examples/mpi_scan.c" $(pkg-config --cflags --libs skiagraph) -lm -o mpi_scan
    sed 's/"NumberOfPixels": *\[[^]]*\]/"NumberOfPixels": [64, 64]/' "$source/examples/scenes/phantom.json" >small.json
    # Open MPI shall run as root as well, and look for no other machine.
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_plm=isolated
    # Equal numbers, whatever the number of processes.
    for processes in 1 2; do
        mpirun --oversubscribe -n $processes ./mpi_scan small.json >projections-$processes.txt
    done
    cmp projections-1.txt projections-2.txt
    grep -c degrees projections-1.txt
    ;;
python)
    need "${4-python3}"
    "$4" "$source/examples/first_image.py" "$(ls "$lib"/libskiagraph.so.?)"
    ;;
esac
