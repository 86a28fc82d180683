#!/bin/sh
# Runs each test of a page, server, pipe, signal, MPI or kill many times, on the machine as it is and then beside busy loops, and
# prints a line a test with its runs and failures. Exit status 1: one failed. Logs of failures stay in BUILD/stress.
#   tests/stress.sh [--build DIR] [--runs N] [--loops N] [TEST...]
# Without TEST: those with the label `stress` (tests/CMakeLists.txt). N: 20 runs and 4 busy loops unless given.
set -eu
usage="usage: tests/stress.sh [--build DIR] [--runs N] [--loops N] [TEST...]"
root=$(cd "$(dirname "$0")/.." && pwd)
build=$root/build runs=20 loops=4
while [ $# -gt 0 ]; do
    case $1 in
    --build | --runs | --loops)
        [ $# -gt 1 ] || { echo "$usage" >&2; exit 2; }
        case $1 in
        --build) build=$2 ;;
        --runs) runs=$2 ;;
        --loops) loops=$2 ;;
        esac
        shift 2 ;;
    -*) echo "$1 is unknown; $usage" >&2; exit 2 ;;
    *) break ;;
    esac
done
if [ $# -eq 0 ]; then
    # shellcheck disable=SC2046
    set -- $(ctest --test-dir "$build" -N -L stress | sed -n 's/^ *Test *#[0-9]*: //p')
    [ $# -gt 0 ] || { echo "$build has no test with the label stress" >&2; exit 2; }
fi
logs=$build/stress
mkdir -p "$logs"
busy=""
# shellcheck disable=SC2086,SC2154
trap 'status=$?; trap - EXIT; [ -z "$busy" ] || kill $busy 2>/dev/null; exit $status' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

bad=0
# run_all WORD TEST...: each test $runs times.
run_all() {
    word=$1
    shift
    for test; do
        failed=0 skipped=0 run=0 began=$(date +%s)
        while [ $run -lt "$runs" ]; do
            run=$((run + 1))
            log=$logs/$test-$word-$run.log
            if ! ctest --test-dir "$build" -R "^$test\$" --timeout 1200 --output-on-failure >"$log" 2>&1; then
                failed=$((failed + 1))
                continue
            fi
            if grep -q '(Skipped)' "$log"; then skipped=$((skipped + 1)); fi
            rm "$log"
        done
        printf '%-28s %-5s %3d runs, %3d failed, %3d skipped, %5d s\n' "$test" "$word" "$runs" $failed $skipped \
            $(($(date +%s) - began))
        bad=$((bad + failed))
    done
}
echo "$(date -u +%Y-%m-%d), $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n 1), $(nproc) CPUs," \
    "load before $(cut -d ' ' -f 1 /proc/loadavg); busy: beside $loops busy loops"
run_all idle "$@"
if [ "$loops" -gt 0 ]; then
    n=0
    while [ $n -lt "$loops" ]; do
        sh -c 'while :; do :; done' &
        busy="$busy $!"
        n=$((n + 1))
    done
    run_all busy "$@"
fi
echo "$bad of $(($# * runs * (1 + (loops > 0)))) runs failed"
[ $bad -eq 0 ]
