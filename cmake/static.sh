#!/bin/sh
# static.sh BUILD: the formats of C files, shellcheck of all scripts, and clang-tidy of the library, the host code and the benchmarks
# with the compile commands of BUILD.
set -eu
cd "$(dirname "$0")/.."
build=$1
find lib host kernels materials tests bench examples docs -name '*.[ch]' -print0 | xargs -0 clang-format-14 --dry-run -Werror
grep -rlE --exclude='*.md' '^(#!/bin/sh|# shellcheck shell)' check demo .ci .github cmake bench tests docs | xargs shellcheck -x
run-clang-tidy-14 -quiet -p "$build" -j "$(nproc)" '/(lib|host|materials|bench)/.*\.c$' >"$build/tidy.log" 2>&1 ||
    { grep -E 'warning:|error:' "$build/tidy.log"; exit 1; }
