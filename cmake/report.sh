# shellcheck shell=sh
# check and demo read this file. It counts tests, lists those that were skipped, and measures the time of each stage.
skg_passed=0 skg_failed=0 skg_skipped=0
skg_skips=""  # a line for each skipped test: its name and the reason
skg_stages="" # the seconds of the stages that ended
skg_stage=""  # the one that goes on, since skg_since
skg_began=$(date +%s)
skg_since=$skg_began

# skg_stage NAME: ends a stage and begins another.
skg_stage() {
    now=$(date +%s)
    [ -z "$skg_stage" ] || skg_stages="$skg_stages$skg_stage $((now - skg_since)) s, "
    skg_stage=$1 skg_since=$now
}

# skg_times: prints the time of each stage and of all.
skg_times() {
    skg_stage ""
    echo "Time: ${skg_stages}in all $(($(date +%s) - skg_began)) s on $(nproc) CPUs."
}

# skg_test DIRECTORY [CTEST OPTION...]: runs tests of a build and counts them. One more than there are CPUs, because tests of pages,
# servers and packages wait.
skg_test() {
    build=$1
    shift
    rm -f "$build/passed"
    { ctest --test-dir "$build" -j "${skg_jobs:-$(($(nproc) + 1))}" --output-on-failure "$@" && touch "$build/passed"; } 2>&1 | tee "$build/tests.log"
    counts=$(awk '/^ *[0-9]+\/[0-9]+ Test +#/ { if (/ Passed /) passed++; else if (/\*\*\*Skipped/) skipped++; else failed++ }
        END { print passed + 0, failed + 0, skipped + 0 }' "$build/tests.log")
    skg_count "$counts"
    skg_skips="$skg_skips$(awk '/^[0-9]+\/[0-9]+ Testing: / { name = $3 }
        /^skipped: / { sub(/^skipped: /, ""); print name ": " $0 }' "$build/Testing/Temporary/LastTest.log")
"
    [ -e "$build/passed" ]
}

# skg_count "PASSED FAILED SKIPPED": adds them to the sum.
skg_count() {
    skg_passed=$((skg_passed + ${1%% *})) skg_skipped=$((skg_skipped + ${1##* }))
    middle=${1% *}
    skg_failed=$((skg_failed + ${middle#* }))
}

# skg_report: what check prints at its end, whether it passed or not. On a machine that tests every change (CI is set) a
# skipped test is a failure, unless tests/skips.txt lists it with this reason.
skg_report() {
    status=$?
    trap - EXIT
    skg_times
    unlisted=$(printf '%s' "$skg_skips" | awk -F ': ' 'NR == FNR { if (!/^(#|$)/) listed[++n] = $0; next }
        NF { for (i = 1; i <= n; i++) {
                 name = substr(listed[i], 1, index(listed[i], ": ") - 1)
                 if ($1 ~ "^(" name ")$" && index($0, substr(listed[i], length(name) + 3))) next
             }
             print "    " $0 }' tests/skips.txt -)
    [ -z "$skg_skips" ] || printf '%s' "$skg_skips" | sed '/./!d; s/^/    skipped: /'
    if [ -n "$unlisted" ] && [ -n "${CI-}" ]; then
        printf 'Skipped, although tests/skips.txt does not list it:\n%s\n' "$unlisted"
        [ $status -ne 0 ] || status=1
    fi
    [ $status -eq 0 ] || [ $skg_failed -gt 0 ] || skg_failed=1 # what failed was no test of ctest
    [ -z "${SKG_TALLY-}" ] || echo "$skg_passed $skg_failed $skg_skipped" >>"$SKG_TALLY"
    echo "$skg_passed passed, $skg_failed failed, $skg_skipped skipped"
    exit $status
}
