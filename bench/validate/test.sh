#!/bin/sh
# usage: test.sh BUILD. Makes the page with the first Python that can, and fails if a bar is missed, or if docs/validation.md was
# made with other kernels.
set -eu
build=$1 status=77
here=$(dirname "$0")
for python in python3 /usr/bin/python3; do
    [ "$status" -eq 77 ] || break
    status=0
    "$here/run" --build "$build" --python "$python" --into "$build/validation.md" >"$build/validation.log" 2>&1 || status=$?
done
cat "$build/validation.log" # of the last Python: another one's lack is no reason for a skipped test
kernels_of() { sed -n 's/^Made .*, kernels \([0-9a-f]*\)\..*/\1/p' "$1"; }
if [ "$status" -eq 0 ] && [ "$(kernels_of "$build/validation.md")" != "$(kernels_of "$here/../../docs/validation.md")" ]; then
    echo "docs/validation.md was made with other kernels; make it again: bench/validate/run"
    status=1
fi
exit "$status"
