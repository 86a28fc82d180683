#!/bin/sh
# flags.sh SOURCE: the command asks for flags by their names. Every name that it asks for is a flag of a manual, and every flag of a
# manual is asked for.
set -eu
cd "$1/host/cli"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat manual/*.c | tr '\n' ' ' | grep -oE 'const cli_flag [a-z_0-9]+ = \{ *"[^"]+"' | grep -oE '"-[^"]+"' | sort -u >"$work/known"
# args.c names flags that no verb has, with advice; --version is a verb.
find . -name '*.c' ! -path './manual/*' ! -path './pages/*' ! -path './common/args.c' -exec cat {} + |
    grep -oE '"(--[a-z0-9-]+|-o)"' | grep -v '"--version"' | sort -u >"$work/asked"
[ "$(wc -l <"$work/known")" -gt 100 ] || { echo "flags.sh reads the manuals no more"; exit 1; }
echo '"--help"' >>"$work/asked" # by the parser itself
sort -u "$work/asked" | comm -3 "$work/known" - | sed 's/^\t\(.*\)/\1 is asked for, and no manual has it/; t; s/$/ is in a manual, and nobody asks for it/' >"$work/wrong"
cat "$work/wrong"
[ ! -s "$work/wrong" ]
