# Sourced by demo and check: makes sure that what the build needs is there. Debian package names.
# skg_need WORDS...: installs what is missing of these packages, or says the exact line and stops.

skg_build_packages="gcc libc6-dev make cmake pkg-config ocl-icd-opencl-dev opencl-headers pocl-opencl-icd \
libassimp-dev libjansson-dev libpng-dev libtiff-dev libcairo2-dev"

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
    # Root installs; others through sudo, where sudo can ask or need not.
    sudo=""
    if [ "$(id -u)" -ne 0 ]; then
        if command -v sudo >/dev/null 2>&1 && { [ -t 0 ] || sudo -n true 2>/dev/null; }; then
            sudo="sudo "
        else
            skg_install=no
        fi
    fi
    if [ "$skg_install" = no ]; then
        echo "Missing packages. As root, run:"
        echo "    apt-get update && $line"
        return 1
    fi
    echo "Installing: $sudo$line"
    ${sudo}apt-get update -qq && ${sudo}env DEBIAN_FRONTEND=noninteractive $line
}

# skg_build DIR OPTIONS...: configures and builds.
skg_build() {
    build=$1
    shift
    cmake -S . -B "$build" "$@" >"$build.log" 2>&1 && cmake --build "$build" -j "$(nproc)" >>"$build.log" 2>&1 || {
        tail -n 40 "$build.log"
        echo "The build failed; the whole log is in $build.log"
        return 1
    }
}
