#!/bin/sh
# house_test.sh CC: house.sh must find an upward include, an upward call and a circle in houses made for it, and nothing in
# a sound one or in one with a hook.
set -eu
cc=$1
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# make NAME: a sound house of two rooms, `low` and in a folder above it `high`, with 120 files that call downward.
make() {
    rm -rf "${work:?}/$1"
    mkdir -p "$work/$1/low" "$work/$1/folder/high"
    cd "$work/$1"
    printf 'int low(void);\nint other(void);\n' >low/low.h
    echo '#include "low.h"' | tee low/other.c folder/high/many.c >low/low.c
    echo 'int low(void) { return 1; }' >>low/low.c
    echo 'int other(void) { return low(); }' >>low/other.c
    printf '#include "high/high.h"\nint high(void) { return 2; }\n' >folder/high/high.c
    echo 'int high(void);' >folder/high/high.h
    i=0
    while [ $((i += 1)) -le 120 ]; do printf '#include "low/low.h"\n' >folder/high/user_$i.h; done
    echo 'int many(void); int many(void) { return low(); }' >>folder/high/many.c
}
# look NAME: what house.sh says of it; the objects are as the files are.
look() {
    cd "$work/$1"
    mkdir -p low.dir/low folder.dir/folder/high
    for file in low/*.c folder/high/*.c; do
        "$cc" -I. -Ifolder -Ilow -c "$file" -o "${file%%/*}.dir/$file.o"
    done
    { printf 'room low %s\nroom high %s\n' "$PWD/low" "$PWD/folder/high"
        for file in low.dir/low/*.o; do echo "object low skg_low $PWD/$file"; done
        for file in folder.dir/folder/high/*.o; do echo "object high skg_high $PWD/$file"; done
        [ ! -d python ] || echo "room python $PWD/python"
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
make python
mkdir -p python/below
printf 'from .other import b\nfrom . import c, d as e\n' >python/a.py
printf 'from __future__ import annotations\nif TYPE_CHECKING:\n    from .a import a\n' >python/other.py
echo | tee python/c.py python/d.py >/dev/null
look python
printf 'from ..a import a\n' >python/below/f.py
printf 'from .below.f import f\n' >python/d.py
expect 'python/a -> python/d (includes d)' python
# A hook is a constant; one that the house does not name, and a function, are calls upward.
make hook
echo 'extern const int up; int down(void); int down(void) { return up; }' >>low/low.c
echo 'const int up = 1;' >>folder/high/high.c
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
