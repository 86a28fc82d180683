#!/bin/sh
# usage: report_test.sh SOURCE: what cmake/report.sh counts, and which skipped tests are failures where CI is set.
set -eu
cd "$1"
unset SKG_TALLY CI

# usage: expect STATUS LAST-LINE CI SKIPS: the report of a check that counted "10 0 2".
expect() {
    status=0
    said=$(CI=$3 skips=$4 sh -euc '. cmake/report.sh
        trap skg_report EXIT
        skg_stage build; skg_stage tests
        skg_count "10 0 2"
        skg_skips=$skips') || status=$?
    last=$(printf '%s\n' "$said" | tail -n 1)
    if [ $status -ne "$1" ] || [ "$last" != "$2" ]; then
        printf '%s\nstatus %s instead of %s, or the last line is not "%s"\n' "$said" $status "$1" "$2"
        exit 1
    fi
}
listed='organs_test: /nowhere is missing; SKG_DATA names its folder
processes_test: one CPU only
'
expect 0 "10 passed, 0 failed, 2 skipped" yes "$listed"
expect 0 "10 passed, 0 failed, 2 skipped" "" "page_test: no chromium
"
expect 1 "10 passed, 1 failed, 2 skipped" yes "${listed}page_test: no chromium
"
expect 1 "10 passed, 1 failed, 2 skipped" yes "organs_test: another reason
"
# A failure outside of a test counts as one failure.
status=0
last=$(sh -euc '. cmake/report.sh; trap skg_report EXIT; skg_stage build; false' | tail -n 1) || status=$?
[ "$last" = "0 passed, 1 failed, 0 skipped" ]
