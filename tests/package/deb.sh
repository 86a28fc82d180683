#!/bin/sh
# Makes Debian packages with CPack, unpacks them into a folder that is not /usr, and uses what is in it. usage: deb.sh BUILD
set -eu
build=$1
stage=$build/deb-test
command -v dpkg-deb >/dev/null 2>&1 || {
    echo "skipped: no dpkg-deb"
    exit 77
}
rm -rf "$stage"
mkdir -p "$stage/root" "$stage/work"
cd "$build"
cpack -G DEB -B "$stage/packages" >"$stage/cpack.log" 2>&1 || {
    tail "$stage/cpack.log"
    exit 1
}
rm -rf "$stage/packages/_CPack_Packages"
has() {
    # shellcheck disable=SC2086
    dpkg-deb -c "$stage"/packages/$1 | grep "$2" >/dev/null || {
        echo "$1 has no $2"
        exit 1
    }
}
has 'libskiagraph0_*.deb' 'libskiagraph.so.0'
has 'libskiagraph0_*.deb' doc/.*LICENSE
has 'libskiagraph-dev_*.deb' include/skiagraph/skiagraph.h
has 'libskiagraph-dev_*.deb' examples/first_image.c
for package in "$stage"/packages/*.deb; do
    dpkg-deb -f "$package" Package Depends
    dpkg-deb -x "$package" "$stage/root"
done
usr=$stage/root/usr
lib=$(dirname "$(find "$usr" -name libskiagraph.so)")
cd "$stage/work"
if [ -e "$usr/bin/skiagraph" ]; then
    has 'skiagraph_*.deb' man1/skiagraph.1
    "$usr/bin/skiagraph" --version # it finds the library beside it
fi
PKG_CONFIG_PATH=$lib/pkgconfig
export PKG_CONFIG_PATH LD_LIBRARY_PATH="$lib"
# shellcheck disable=SC2046
cc -std=c11 "$usr"/share/doc/*/examples/first_image.c $(pkg-config --cflags --libs skiagraph) -lm -o first_image
./first_image
if [ -d "$usr/lib/python3" ]; then
    for python in python3 /usr/bin/python3; do
        if $python -c "import cffi, numpy, sys; sys.exit(sys.version_info < (3, 10))" 2>/dev/null; then
            PYTHONPATH=$usr/lib/python3/dist-packages $python -c "import skiagraph; print(skiagraph.Material('water'))"
            break
        fi
    done
fi
