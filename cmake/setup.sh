# shellcheck shell=sh
# demo and check read this file. It makes sure that what the build needs is there. Packages have their Debian names.

# shellcheck disable=SC2034
skg_build_packages="gcc libc6-dev make cmake pkg-config ocl-icd-opencl-dev opencl-headers pocl-opencl-icd \
libassimp-dev libcglm-dev libjansson-dev libpng-dev zlib1g-dev libtiff-dev libcairo2-dev"

# Without these something is left out: HDF5 files of scans, scans under MPI, films as .gif, films as .mp4 and .webm, pages
# of large scenes with fewer triangles, fits by CMA-ES.
# shellcheck disable=SC2034
skg_optional_packages="libhdf5-dev libopenmpi-dev openmpi-bin libgif-dev ffmpeg libmeshoptimizer-dev liblapacke-dev"

# skg_need PACKAGE...: installs those that are missing, or prints the line that does and stops.
skg_need() {
    if ! command -v dpkg-query >/dev/null 2>&1 || ! command -v apt-get >/dev/null 2>&1; then
        echo "This is no Debian: nothing is installed. Needed, by their Debian names: $*"
        return 0
    fi
    missing=""
    for package in "$@"; do
        dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
    done
    [ -z "$missing" ] && return 0
    line="apt-get install -y --no-install-recommends$missing"
    # Root installs. Others do it through sudo, if sudo needs no password or can ask for it.
    sudo=""
    if [ "$(id -u)" -ne 0 ]; then
        if command -v sudo >/dev/null 2>&1 && { [ -t 0 ] || sudo -n true 2>/dev/null; }; then
            sudo=sudo
        else
            skg_install=no
        fi
    fi
    if [ "$skg_install" = no ]; then
        echo "Missing packages. As root, run:"
        echo "    apt-get update && $line"
        return 1
    fi
    echo "Installing: $sudo $line"
    # shellcheck disable=SC2086
    $sudo apt-get update -qq && $sudo env DEBIAN_FRONTEND=noninteractive $line
}

# skg_build PRESET [TARGET...]: configures one of CMakePresets.json, and builds these targets or all.
skg_build() {
    preset=$1
    shift
    if ! { cmake --preset "$preset" && cmake --build --preset "$preset" -j "$(nproc)" ${1:+--target "$@"}; } \
        >"build-$preset.log" 2>&1; then
        tail -n 40 "build-$preset.log"
        echo "The build failed; the whole log is in build-$preset.log"
        return 1
    fi
}
