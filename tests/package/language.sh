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
    ./first_image_f
    sed 's/"NumberOfPixels": *\[[^]]*\]/"NumberOfPixels": [64, 64]/' "$source/examples/scenes/phantom.json" >small.json
    ./thousand_images_f small.json marker
    ;;
python)
    need python3
    python3 "$source/examples/first_image.py" "$(ls "$lib"/libskiagraph.so.?)"
    ;;
esac
