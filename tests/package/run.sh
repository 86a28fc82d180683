#!/bin/sh
# Installs the build tree into BUILD/package-test and uses it from there as a stranger would: pkg-config, CMake,
# and the command. usage: run.sh SOURCE BUILD
set -eu
source=$1
build=$2
stage=$build/package-test
rm -rf "$stage"
mkdir -p "$stage/work"
cmake --install "$build" --prefix "$stage/usr" >"$stage/install.log"
lib=$(dirname "$(find "$stage/usr" -name 'libskiagraph.so')")
export PKG_CONFIG_PATH="$lib/pkgconfig" LD_LIBRARY_PATH="$lib"
cd "$stage/work"

echo "pkg-config:"
pkg-config --validate skiagraph
for name in first_image hundred_poses scene_loop registration; do
    # shellcheck disable=SC2046
    cc -std=c11 -Wall -Wextra -Werror "$source/examples/$name.c" $(pkg-config --cflags --libs skiagraph) -lm -o $name
    case $name in
    scene_loop | registration) ./$name "$source/examples/scenes/phantom.json" marker ;;
    *) ./$name ;;
    esac
done

echo "CMake:"
cmake -S "$source/examples" -B cmake -DCMAKE_PREFIX_PATH="$stage/usr" >cmake.log
cmake --build cmake >>cmake.log
cmake/first_image
cmake/on_device

if [ -e "$lib/libskiagraph.a" ]; then
    # But for the locks of OpenMP, which are common to a whole program.
    echo "the static library has the public symbols only:"
    nm -D --defined-only "$lib/libskiagraph.so" | sed -n 's/.* \(skg_[^@]*\).*/\1/p' | sort >public
    nm -g --defined-only "$lib/libskiagraph.a" | sed -n 's/^[0-9a-f]* [A-Z] //p' | sed '/^\.gomp_critical_user_skg_/d' | sort |
        diff public - || exit 1
    # A program may have functions with the names of private ones.
    printf '#include <skiagraph/skiagraph.h>\nint skg_fail(void);\nint skg_fail(void) { return 0; }\nint main(void) {\n%s\n}\n' \
        'skg_mesh *mesh = 0; return skg_mesh_create_cube(-1, &mesh) == SKG_ERR_ARGUMENT ? skg_fail() : 1;' >same_name.c
    # shellcheck disable=SC2046
    cc -std=c11 same_name.c $(pkg-config --cflags skiagraph) \
        $(pkg-config --static --libs skiagraph | sed 's/-lskiagraph/-l:libskiagraph.a/') -o same_name
    ./same_name
    echo "the static library, by pkg-config and by CMake:"
    # shellcheck disable=SC2046
    cc -std=c11 "$source/examples/first_image.c" $(pkg-config --cflags skiagraph) \
        $(pkg-config --static --libs skiagraph | sed 's/-lskiagraph/-l:libskiagraph.a/') -o first_image_static
    mkdir -p components
    cat >components/CMakeLists.txt <<END
cmake_minimum_required(VERSION 3.25)
project(components LANGUAGES C)
find_package(skiagraph REQUIRED COMPONENTS static opencl)
add_executable(first_image $source/examples/first_image.c)
target_link_libraries(first_image PRIVATE skiagraph::static m)
file(WRITE opencl.c "#include <skiagraph/opencl.h>\nint main(void) { return (int)skg_last_cl_error(); }\n")
add_executable(opencl opencl.c)
target_link_libraries(opencl PRIVATE skiagraph::opencl)
END
    cmake -S components -B components/build -DCMAKE_PREFIX_PATH="$stage/usr" >components.log
    cmake --build components/build >>components.log
    for program in ./first_image_static components/build/first_image; do
        if ldd $program | grep libskiagraph; then exit 1; fi
        # The static program has the self-tests of the device, which no call of it names.
        rm -rf tested
        SKG_CACHE_DIR=$PWD/tested $program
        find tested -name '*.verdict' | grep -q . || { echo "$program did not test its device"; exit 1; }
    done
    components/build/opencl
fi

echo "skiagraph/opencl.h by pkg-config:"
# shellcheck disable=SC2046
printf '#include <skiagraph/opencl.h>\nint main(void) { return (int)skg_last_cl_error(); }\n' |
    cc -std=c11 -xc - $(pkg-config --cflags --libs skiagraph-opencl) -o opencl_pc
./opencl_pc
# shellcheck disable=SC2046
cc -std=c11 -Wall -Wextra -Werror "$source/examples/on_device.c" $(pkg-config --cflags --libs skiagraph-opencl) -lm -o on_device
./on_device

echo "every public header compiles alone, in C and as it stands:"
for header in "$stage"/usr/include/skiagraph/*.h; do
    # shellcheck disable=SC2046
    printf '#include <skiagraph/%s>\nextern int one;\n' "$(basename "$header")" |
        cc -std=c11 -Wall -Wextra -Wpedantic -Werror -fsyntax-only $(pkg-config --cflags skiagraph) -xc -
done

echo "only skg_ names are exported, and the nodes of their versions:"
if nm -D --defined-only "$lib/libskiagraph.so" | grep -v -e ' [A-Z] skg_.*@@SKIAGRAPH_' -e ' A SKIAGRAPH_'; then exit 1; fi

if [ -x "$stage/usr/bin/skiagraph" ]; then "$stage/usr/bin/skiagraph" --version; fi
