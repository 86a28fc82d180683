#!/bin/sh
# house_test.sh CC: house.sh must find an upward include, an upward call and a circle in houses made for it, and nothing in
# a sound one or in one with a hook.
set -eu
cc=$1
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# make NAME: a sound house of two rooms, `low` and `high`, with 120 files that call downward.
make() {
    rm -rf "${work:?}/$1"
    mkdir -p "$work/$1/low" "$work/$1/high"
    cd "$work/$1"
    printf 'int low(void);\nint other(void);\n' >low/low.h
    echo '#include "low.h"' | tee low/other.c high/many.c >low/low.c
    echo 'int low(void) { return 1; }' >>low/low.c
    echo 'int other(void) { return low(); }' >>low/other.c
    printf '#include "high/high.h"\nint high(void) { return 2; }\n' >high/high.c
    echo 'int high(void);' >high/high.h
    i=0
    while [ $((i += 1)) -le 120 ]; do printf '#include "low/low.h"\n' >high/user_$i.h; done
    echo 'int many(void); int many(void) { return low(); }' >>high/many.c
}
# look NAME: what house.sh says of it; the objects are as the files are.
look() {
    cd "$work/$1"
    mkdir -p low.dir/low high.dir/high
    for file in low/*.c high/*.c; do
        "$cc" -I. -Ilow -c "$file" -o "${file%%/*}.dir/$file.o"
    done
    { printf 'room low %s\nroom high %s\n' "$PWD/low" "$PWD/high"
        for file in low.dir/low/*.o; do echo "object low skg_low $PWD/$file"; done
        for file in high.dir/high/*.o; do echo "object high skg_high $PWD/$file"; done
        [ ! -f hooks ] || cat hooks; } >house.txt
    sh "$here/house.sh" house.txt
}
# expect TEXT NAME: fails unless house.sh fails and says TEXT.
expect() {
    if look "$2" >"$work/said"; then echo "$2: not found"; exit 1; fi
    grep -qF "$1" "$work/said" || { cat "$work/said"; echo "$2: not said: $1"; exit 1; }
}

make sound
look sound
make upward_include
echo '#include "high/high.h"' >>low/low.c
expect 'upward: low/low -> high/high (includes high/high.h)' upward_include
make upward_call
echo 'int high(void); int up(void); int up(void) { return high(); }' >>low/low.c
expect 'upward: low/low -> high/high (calls high)' upward_call
# A hook is a constant; one that the house does not name, and a function, are calls upward.
make hook
echo 'extern const int up; int down(void); int down(void) { return up; }' >>low/low.c
echo 'const int up = 1;' >>high/high.c
expect 'upward: low/low -> high/high (calls up)' hook
echo 'hook up' >hooks
look hook
make hooked_call
echo 'int high(void); int up(void); int up(void) { return high(); }' >>low/low.c
echo 'hook high' >hooks
expect 'upward: low/low -> high/high (calls high)' hooked_call
make circle
echo 'int again(void); int again(void) { return other(); }' >>low/low.c
expect 'low/low -> low/other (calls other)' circle
