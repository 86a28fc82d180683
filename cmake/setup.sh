# shellcheck shell=sh
# demo and check read this file. It makes sure that what the build needs is there. Packages have their Debian names.

# shellcheck disable=SC2034
skg_build_packages="gcc libc6-dev make cmake pkg-config ocl-icd-opencl-dev opencl-headers pocl-opencl-icd \
libassimp-dev libcglm-dev libjansson-dev libpng-dev zlib1g-dev libtiff-dev libzip-dev libmd-dev libcairo2-dev"

# Without these something is left out; the README has a table of it.
# shellcheck disable=SC2034
skg_optional_packages="libhdf5-dev libgif-dev ffmpeg libmeshoptimizer-dev libcivetweb-dev"
# shellcheck disable=SC2034
skg_mpi_packages="libopenmpi-dev openmpi-bin"

# Packages for tests. libxrl-dev: an independent table of cross sections. chromium: pages work in it. groff-base: the pages of the
# manual. ninja-build: looks at all files in a tenth of a second.
# shellcheck disable=SC2034
skg_test_packages="check gfortran g++ python3 python3-numpy python3-cffi python3-pytest python3-scipy python3-venv oclgrind libxrl-dev \
doxygen chromium groff-base locales dcmtk python3-pydicom python3-jsonschema ninja-build"

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
    { $sudo apt-get update -qq && $sudo env DEBIAN_FRONTEND=noninteractive $line; } >packages.log 2>&1 || {
        tail -n 20 packages.log
        echo "Packages could not be installed; the whole log is in packages.log"
        return 1
    }
}

# skg_python_packages: what tests need and Debian lacks, in an environment in the build folder on top of Debian's Python:
# the toolbox (on SciPy) of the authors of CTSimU scenarios. Where that fails, build/venv.missing holds the reason for the test that
# is skipped: a registry that is not reached is one of tests/skips.txt, anything else is not.
skg_python_packages() {
    [ "$skg_install" = yes ] && [ -x /usr/bin/python3 ] || return 0
    venv=build/venv
    [ -e $venv/complete ] && return 0
    mkdir -p build
    { /usr/bin/python3 -m venv --system-site-packages $venv && $venv/bin/python -m pip install -q ctsimu; } \
        >build/venv.log 2>&1 && touch $venv/complete && rm -f build/venv.missing && return 0
    if grep -qE 'from versions: none|Failed to establish a new connection|Could not fetch URL|Read timed out' build/venv.log; then
        echo "the registry of Python is not reached" >build/venv.missing
    else
        echo "pip does not install ctsimu" >build/venv.missing
    fi
    tail -n 2 build/venv.log
    echo "The Python package ctsimu cannot be installed: $(cat build/venv.missing); the whole log is in build/venv.log"
}

# skg_build PRESET [TARGET...]: configures one of CMakePresets.json, and builds these targets or all. A new folder is for Ninja, if it is
# there; others keep what they were configured for.
skg_build() {
    preset=$1 ninja=""
    shift
    case $preset in dev) folder=build ;; *) folder=build-$preset ;; esac
    if [ ! -e "$folder/CMakeCache.txt" ] && command -v ninja >/dev/null 2>&1; then ninja=yes; fi
    if ! { cmake --preset "$preset" ${ninja:+-G Ninja} && cmake --build --preset "$preset" -j "${skg_jobs:-$(nproc)}" ${1:+--target "$@"}; } \
        >"build-$preset.log" 2>&1; then
        tail -n 40 "build-$preset.log"
        echo "The build failed; the whole log is in build-$preset.log"
        return 1
    fi
}

# skg_build_aloud PRESET [TARGET...]: the same, and says how far it is: in one line of a terminal, or else a line for each tenth.
skg_build_aloud() {
    echo "Building; the log is build-$1.log:"
    rm -f "build-$1.log"
    skg_build "$@" &
    job=$! began=$(date +%s) said=-1
    while kill -0 "$job" 2>/dev/null; do
        percent=$(awk '/^\[ *[0-9]+%\]/ { gsub(/[^0-9]/, "", $1); sub(/^\[ */, ""); p = $0 + 0 }
            /^\[[0-9]+\/[0-9]+\]/ { split($1, n, /[^0-9]+/); p = int(100 * n[2] / n[3]) } END { print p + 0 }' \
            "build-$1.log" 2>/dev/null || echo 0)
        if [ -t 1 ]; then
            printf '\r  %3d %%, %d s' "$percent" "$(($(date +%s) - began))"
        elif [ "$((percent / 10))" -gt "$said" ]; then
            said=$((percent / 10))
            printf '  %d %%, %d s\n' "$percent" "$(($(date +%s) - began))"
        fi
        sleep 1
    done
    [ ! -t 1 ] || echo
    wait "$job"
}
