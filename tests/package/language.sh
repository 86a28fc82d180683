#!/bin/sh
# The installed tree that run.sh left behind, used from another language. usage: language.sh fortran|python SOURCE BUILD
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
    # shellcheck disable=SC2046
    gfortran -std=f2008 -Wall "$source/examples/first_image.f90" $(pkg-config --libs skiagraph) -o first_image_f
    ./first_image_f
    ;;
python)
    need python3
    python3 "$source/examples/first_image.py" "$(ls "$lib"/libskiagraph.so.?)"
    ;;
esac
