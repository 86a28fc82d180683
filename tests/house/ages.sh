#!/bin/sh
# The test `ages`: no measurement is older than ages.txt says, each one has a date, and each file of bench/results is listed.
# Usage: ages.sh SOURCE
set -eu
list=$(dirname "$0")/ages.txt
cd "$1"
skip() {
    echo "skipped: $1"
    exit 77
}
[ "$(git rev-parse --show-toplevel 2>/dev/null)" = "$(pwd -P)" ] || skip "the source is no repository of git"
[ "$(git rev-parse --is-shallow-repository)" = false ] || skip "the repository is shallow"
failed=0
complain() {
    echo "$1"
    failed=1
}
for file in bench/results/*.md; do
    grep -q "^$file " "$list" || complain "$file: is not in tests/house/ages.txt; add it with the age that it may have"
done
# The commit and the date stand in the head of a result, and in the sentence about coverage in docs/architecture.md. A commit
# of another history is passed over for the date.
grep -v '^#' "$list" | {
    while read -r file most folders; do
        folders=${folders%%#*}
        [ -n "${folders%% *}" ] || folders='lib kernels host'
        [ -f "$file" ] || { complain "$file: is listed in tests/house/ages.txt, and is not there"; continue; }
        commit=$(sed -n -e 's/^- commit: \([0-9a-f]*\).*/\1/p' -e 's/^- old: \([0-9a-f]*\),.*/\1/p' \
            -e 's/^On 2[0-9-]*, at commit \([0-9a-f]*\), these tests ran .*/\1/p' "$file" | head -n 1)
        date=$(sed -n -e 's/^- date: \([0-9T:-]*\)Z.*/\1/p' -e 's/^On \(2[0-9-]*\), at commit .* these tests ran .*/\1T00:00/p' \
            "$file" | head -n 1)
        [ -n "$date" ] || { complain "$file: has no line \"- date: 2026-11-23T20:01Z\""; continue; }
        if [ -n "$commit" ] && git merge-base --is-ancestor "$commit" HEAD 2>/dev/null; then
            # shellcheck disable=SC2086 # a word a folder
            age=$(git rev-list --count "$commit..HEAD" -- $folders)
        else
            # shellcheck disable=SC2086
            age=$(git rev-list --count --since="${date}Z" HEAD -- $folders)
        fi
        echo "$file: $age of $most commits"
        [ "$age" -le "$most" ] || complain "$file: $age commits to $folders since $date, $most are allowed; measure again"
    done
    exit $failed
} || failed=1
exit $failed
