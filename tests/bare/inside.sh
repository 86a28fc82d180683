#!/bin/sh
# usage: inside.sh FULL: what ./check --bare runs in the bare Debian: ./demo, the command lines of the documentation, ./check (FULL is
# yes: ./check --full), and the tests that name measured data once more without them. Ends with the sum of the tests.
set -eu
cd "$(dirname "$0")/../.."
export SKG_TALLY=/root/tally
. cmake/report.sh
sum() {
    status=$?
    trap - EXIT
    skg_times
    [ $status -eq 0 ] || [ -s $SKG_TALLY ] || echo "0 1 0" >>$SKG_TALLY
    awk '{ p += $1; f += $2; s += $3 } END { print p " passed, " f " failed, " s " skipped" }' $SKG_TALLY
    exit $status
}
trap sum EXIT
trap 'exit 130' INT
skg_stage demo
./demo
skg_stage "command lines of the documentation"
docs/blocks.sh list
docs/blocks.sh run /root/scratch
skg_stage "./check"
if [ "$1" = yes ]; then
    ./check --full # with the catalogue of hard cases
else
    ./check
fi
skg_stage "without measured data"
if [ -d ../shared/data ]; then
    SKG_DATA=/nowhere ctest --test-dir build -j "$(nproc)" --output-on-failure -L data
fi
