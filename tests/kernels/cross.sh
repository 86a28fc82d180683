#!/bin/sh
# cross.sh CLANG FOLDER: compiles each program that dump_programs.c wrote to FOLDER for the targets of other vendors'
# compilers, with warnings as errors. Programs that use double are compiled with fp64; the others also for a device that
# has none.
set -eu
clang=$1 folder=$2
programs=0 compiled=0 bad=0
for program in "$folder"/*.cl; do
    [ -e "$program" ] || break
    programs=$((programs + 1))
    # Of the options only the -D: those that begin with -cl are the driver's.
    defines=$(sed -n '1s|^// ||p' "$program" | tr ' ' '\n' | awk '$0 == "-D" { getline; print "-D" $0 }')
    case $defines in
    *SKG_DOUBLE=1* | *SKG_OUTPUT_DOUBLE=1*) variants=fp64 ;;
    *) variants="fp64 none" ;;
    esac
    for target in "amdgcn-amd-amdhsa -nogpulib" nvptx64 spir64; do
        for variant in $variants; do
            ext=""
            [ "$variant" = none ] && ext="-Xclang -cl-ext=-cl_khr_fp64"
            compiled=$((compiled + 1))
            # shellcheck disable=SC2086
            if ! "$clang" -target $target -x cl -cl-std=CL1.2 -Xclang -finclude-default-header $ext $defines \
                -O1 -S -emit-llvm -Wall -Wextra -Werror -Wno-unused-function -Wno-unused-parameter \
                -Wno-unknown-pragmas -o /dev/null \
                "$program" >"$folder/cross.log" 2>&1; then
                bad=$((bad + 1))
                echo "$program for $target, $variant:"
                head -n 20 "$folder/cross.log"
            fi
        done
    done
done
echo "$programs programs, compiled $compiled times, $bad failed"
[ "$programs" -gt 0 ] && [ "$bad" -eq 0 ]
