#!/bin/sh
# Makes the Debian packages as the preset does, installs them in a folder that is not /, and uses what is in it.
# usage: deb.sh SOURCE BUILD PYTHON COMPILER [LAUNCHER]
set -eu
source=$1
build=$2
python=$3
stage=$build/deb-test
command -v dpkg-deb >/dev/null 2>&1 || {
    echo "skipped: no dpkg-deb"
    exit 77
}
fail() {
    echo "$*"
    exit 1
}
rm -rf "$stage"
mkdir -p "$stage/root/var/lib/dpkg/updates" "$stage/root/var/lib/dpkg/info" "$stage/work" "$stage/packages"
: >"$stage/root/var/lib/dpkg/status"

echo "a build folder with another folder of libraries makes no packages:"
if grep -q '^CMAKE_INSTALL_LIBDIR:PATH=lib$' "$build/CMakeCache.txt"; then
    (cd "$build" && cpack -G DEB -B "$stage/refused" 2>&1) | grep 'cmake --preset debian'
fi

# Kept, so that a second run has little to compile.
folder=$build/deb-build
(
    cd "$source"
    cmake --preset debian -B "$folder" -DPython3_EXECUTABLE="$python" -DCMAKE_C_COMPILER="$4" -DCMAKE_C_COMPILER_LAUNCHER="${5:-}"
    cmake --build "$folder" -j "$(nproc)"
    cd "$folder"
    cpack -B "$stage/packages"
) >"$stage/build.log" 2>&1 || {
    tail "$stage/build.log"
    exit 1
}
rm -rf "$stage/packages/_CPack_Packages"
multiarch=$(sed -n 's|^set(CPACK_SKG_DEBIAN_LIBDIR "\(.*\)")|\1|p' "$folder/CPackConfig.cmake")

# Of PACKAGE, a file whose path ends in the second word; the value of a field.
has() {
    dpkg-deb -c "$stage/packages/$1"_*.deb | grep "\./$2\$" >/dev/null || fail "$1 has no /$2"
}
field() {
    dpkg-deb -f "$stage/packages/$1"_*.deb "$2"
}
depends() {
    field "$1" Depends | grep "$2" >/dev/null || fail "$1 does not depend on $2, but on: $(field "$1" Depends)"
}
count=$(find "$stage/packages" -name '*.deb' | wc -l)
[ "$count" -eq 4 ] || fail "$count packages instead of 4"
has libskiagraph0 "usr/$multiarch/libskiagraph.so.0 -> libskiagraph.so.*"
has libskiagraph0 usr/share/doc/skiagraph/LICENSE
has libskiagraph-dev "usr/$multiarch/libskiagraph.so -> libskiagraph.so.0"
has libskiagraph-dev "usr/$multiarch/libskiagraph.a"
has libskiagraph-dev "usr/$multiarch/pkgconfig/skiagraph.pc"
has libskiagraph-dev "usr/$multiarch/cmake/skiagraph/skiagraph-config.cmake"
has libskiagraph-dev usr/include/skiagraph/skiagraph.h
has libskiagraph-dev usr/share/doc/skiagraph/examples/first_image.c
if command -v doxygen >/dev/null 2>&1; then has libskiagraph-dev usr/share/man/man3/skg_mesh_load.3; fi
has skiagraph usr/bin/skiagraph
has skiagraph usr/share/man/man1/skiagraph.1
has python3-skiagraph usr/lib/python3/dist-packages/skiagraph/__init__.py
version=$(field libskiagraph0 Version)
for name in libskiagraph-dev skiagraph python3-skiagraph; do
    depends $name "libskiagraph0 (= $version)"
done
depends python3-skiagraph python3-cffi
[ "$(field python3-skiagraph Architecture)" = all ] || fail "python3-skiagraph depends on the machine"
if command -v dpkg-shlibdeps >/dev/null 2>&1; then
    depends libskiagraph0 libassimp
    depends skiagraph libcairo
fi

# dpkg refuses packages that hold the same file; it needs root. Dependencies are those of this system, not of the folder.
if [ "$(id -u)" -eq 0 ]; then
    dpkg --root="$stage/root" --force-depends --unpack "$stage"/packages/*.deb >"$stage/dpkg.log" 2>&1 || {
        cat "$stage/dpkg.log"
        exit 1
    }
else
    for package in "$stage"/packages/*.deb; do dpkg-deb -x "$package" "$stage/root"; done
fi
usr=$stage/root/usr
lib=$usr/$multiarch
cd "$stage/work"
"$usr/bin/skiagraph" --version # it finds the library by its own path
export PKG_CONFIG_PATH="$lib/pkgconfig" LD_LIBRARY_PATH="$lib"
# shellcheck disable=SC2046
cc -std=c11 "$usr"/share/doc/skiagraph/examples/first_image.c $(pkg-config --cflags --libs skiagraph) -lm -o first_image
./first_image
cmake -S "$usr/share/doc/skiagraph/examples" -B cmake -DCMAKE_PREFIX_PATH="$usr" >cmake.log 2>&1 || fail "$(cat cmake.log)"
cmake --build cmake --target first_image >>cmake.log 2>&1 || fail "$(tail cmake.log)"
cmake/first_image
if "$python" -c "import cffi, numpy" 2>/dev/null; then
    PYTHONPATH=$usr/lib/python3/dist-packages "$python" -c "import skiagraph; print(skiagraph.Material('water'))"
fi
