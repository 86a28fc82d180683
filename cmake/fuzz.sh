#!/bin/sh
# Lets libFuzzer run on each target for $SKG_FUZZ_SECONDS (60); an input that ends the program stays in build-fuzz/found with its
# log. Not on hdf5: HDF5 1.10 itself writes beyond its memory when it opens damaged files. Its corpus is run by ctest.
set -eu
cd "$(dirname "$0")/.."
. cmake/setup.sh
targets="scene grammar settings ctsimu xtekct mesh archive instances columns live words"
# shellcheck disable=SC2046,SC2086 # a word a target
skg_build fuzz $(printf 'fuzz_%s ' $targets)
for target in $targets; do
    mkdir -p "build-fuzz/found/$target"
    echo "fuzz_$target: ${SKG_FUZZ_SECONDS:-60} s"
    LSAN_OPTIONS="suppressions=$PWD/tests/fuzz/lsan.txt:print_suppressions=0" \
        "build-fuzz/bin/fuzz_$target" -max_total_time="${SKG_FUZZ_SECONDS:-60}" -timeout=60 -close_fd_mask=3 \
        -artifact_prefix=build-fuzz/found/ "build-fuzz/found/$target" "tests/fuzz/corpus/$target" \
        >"build-fuzz/found/$target.log" 2>&1 || { tail -n 40 "build-fuzz/found/$target.log"; exit 1; }
done
