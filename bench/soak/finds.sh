#!/bin/sh
# The long mixed run finds each deliberate fault, and none without one. usage: finds.sh BENCH_SOAK
set -eu
into=$(mktemp -d)
trap 'rm -rf "$into"' EXIT
# expect BENCH_SOAK STATUS SENTENCE FAULT
expect() {
    status=0
    "$1" --quick --seconds 4 --seed 1 --into "$into" --fault "$4" >"$into/said" 2>&1 || status=$?
    if [ "$status" -ne "$2" ] || ! grep -q "$3" "$into/said"; then
        echo "with the fault \"$4\" the exit status was $status, and \"$3\" was expected:"
        cat "$into/said"
        exit 1
    fi
    echo "$4: $(tail -n 1 "$into/said")"
}
expect "$1" 0 'Equal bits' none
expect "$1" 1 'pieces of the library.s memory were never released' piece
expect "$1" 1 'memory has grown' heap
expect "$1" 1 'file handles more' handle
expect "$1" 1 'lost.part-1 was left behind' file
expect "$1" 1 'are not those of before' bits
