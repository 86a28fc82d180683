#!/bin/sh
# usage: run.sh FULL, from the project's folder, as root. FULL: yes for every test. Makes a Debian 12 with nothing in it in a folder, copies the project
# with its history into it, and runs inside.sh there. The mounts belong to a namespace, so they end with its processes,
# however this script ends. Exit status 3: no such Debian can be made on this machine.
set -eu
full=$1
impossible() {
    echo "check: no bare Debian can be made here: $1" >&2
    exit 3
}
[ "$(id -u)" -eq 0 ] || impossible "it needs root"
. cmake/setup.sh
skg_install=yes
skg_need mmdebstrap git ca-certificates || impossible "mmdebstrap and git cannot be installed"
unshare --mount --pid --fork --kill-child true 2>/dev/null || impossible "this root may not make mounts"
sources=$(ls /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources 2>/dev/null || true)

work=$(mktemp -d "${TMPDIR:-/tmp}/skg-bare-XXXXXX")
child=""
clean() {
    status=$?
    trap - EXIT INT TERM HUP
    [ -z "$child" ] || kill -KILL "$child" 2>/dev/null || true
    # Processes of the namespace may still be ending.
    rm -rf --one-file-system "$work" 2>/dev/null || { sleep 2; rm -rf --one-file-system "$work"; }
    exit $status
}
trap clean EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
trap 'exit 129' HUP

# Debian's own entries of the machine's sources: those of the suite and component of Debian 12.
for file in $sources; do
    case $file in
    *.sources) awk 'BEGIN { RS = ""; ORS = "\n\n" }
        /Suites:[^\n]* bookworm/ && /Components:[^\n]* main/ && !/Enabled: *no/' "$file" | grep -v '^#' || true ;;
    esac
done >"$work/debian.sources"
for file in $sources; do
    case $file in
    *.list) grep -hE '^deb .* bookworm(-updates|-security)? +([a-z-]+ +)*main( |$)' "$file" || true ;;
    esac
done >"$work/debian.list"
set --
for file in "$work/debian.sources" "$work/debian.list"; do
    if [ -s "$file" ]; then set -- "$@" "$file"; fi
done
[ $# -gt 0 ] || impossible "the machine's sources of packages have none of Debian 12"
git clone -q . "$work/project"
if [ -n "$(git status --porcelain)" ]; then echo "What is not committed is not tested."; fi

mkdir "$work/root"
unshare --mount --pid --fork --kill-child sh tests/bare/enter.sh "$work" "$(dirname "$PWD")/shared" "$full" "$@" &
child=$!
wait $child
