#!/bin/sh
# cross_small.sh CLANG DUMP FOLDER PROGRAM GROUP...: runs PROGRAM for each group, with the library DUMP preloaded, and compiles
# what it built for other targets (cross.sh).
set -eu
clang=$1 dump=$2 folder=$3 program=$4
shift 4
rm -rf "$folder"
mkdir -p "$folder"
for group in "$@"; do
    # Nothing that was kept is used, so that every program is built from its sources.
    SKG_CACHE_DIR=none SKG_DUMP="$folder" LD_PRELOAD="$dump" "$program" "$group" >/dev/null
done
exec "$(dirname "$0")/cross.sh" "$clang" "$folder"
