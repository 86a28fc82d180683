#!/bin/sh
# house.sh HOUSE: fails on an include or a call upward between rooms, and on a circle between files. A .c and its .h
# are one file here. The package of Python counts as a room, with imports that run when a module is loaded, which are those
# without indentation. HOUSE has lines `room NAME FOLDER`, from the ground up, `object ROOM TARGET FILE`, and `hook NAME`
# (CMakeLists.txt writes it). Includes are read from the sources, calls from the objects' symbols. A hook is a constant that
# a lower room declares and an upper room defines: reading it is no call upward. It must be data.
set -eu
house=$1
here=$(dirname "$0")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

awk '$1 == "room" { print $2, ++rank }' "$house" >"$work/ranks"
# Lines `file FILE`, `include FILE NAME` and `symbol ROOM TARGET OBJECT NAME TYPE`.
awk '$1 == "room" && $3 != "-" { print $2, $3 }' "$house" | while read -r room folder; do
    # shellcheck disable=SC2016
    (cd "$folder" && find . -name '*.[ch]' -o -name '*.hpp' -o -name '*.cl' -o -name '*.clh' -o -name '*.py' | sed 's|^\./||' | xargs awk -v room="$room" '
        FNR == 1 { print "file", room "/" FILENAME }
        /^ *# *include/ { sub(/^ *# *include */, ""); print "include", room "/" FILENAME, $1 }
        /^from \.[A-Za-z_.]* import / && FILENAME ~ /\.py$/ {
            from = $2
            sub(/^from \.[A-Za-z_.]* import /, "")
            if (from !~ /[a-z]$/) { # names of modules
                n = split($0, name, /, */)
                for (i = 1; i <= n; i++) { sub(/ .*/, "", name[i]); print "import", room "/" FILENAME, from name[i] }
            } else print "import", room "/" FILENAME, from
        }')
done >"$work/facts"
awk '$1 == "object" { print $4 }' "$house" | sort -u | xargs "${NM:-nm}" -A -P >"$work/symbols"
awk 'FNR == NR { if ($1 == "object") heads[$4] = heads[$4] "symbol " $2 " " $3 " " $4 "\n"; next }
    $3 ~ /^[A-Zw]$/ {
        sub(/:$/, "", $1)
        n = split(heads[$1], head, "\n")
        for (i = 1; i < n; i++) print head[i], $2, $3
    }' "$house" "$work/symbols" >>"$work/facts"

awk '$1 == "hook"' "$house" >>"$work/facts"

# Arrows `FROM TO REASON` between files, then those that point up, then circles.
awk -f "$here/arrows.awk" "$work/facts" | sort -u >"$work/arrows"
awk 'FNR == NR { rank[$1] = $2; next }
    function room(file) {
        if (file ~ /^(cli|bench|python|gvxr|kernels)\//) return substr(file, 1, index(file, "/") - 1) # these have folders inside
        sub(/\/[^\/]*$/, "", file)
        return file
    }
    rank[room($1)] < rank[room($2)] { print "upward: " $1 " -> " $2 " (" $3 " " $4 ")" }
    ' "$work/ranks" "$work/arrows" >"$work/upward"
awk '$1 != $2 { print $1, $2 }' "$work/arrows" | tsort 2>"$work/loops" >/dev/null || true
# tsort names the files of each loop in order, and some loops twice.
awk 'FNR == NR { why[$1, $2] = $3 " " $4; next }
    function end_of_circle(   i, j, first, text, key) {
        first = 1
        for (i = 2; i <= n; i++) if (node[i] < node[first]) first = i
        for (i = 0; i < n; i++) {
            key = key node[(first + i - 1) % n + 1] " "
            for (j = 1; j >= -1; j -= 2) { # which way round tsort went
                from = node[(first + i - 1) % n + 1]; to = node[(first + i - 1 + j + n) % n + 1]
                if ((from, to) in why && (n > 2 || j == 1)) text = text "    " from " -> " to " (" why[from, to] ")\n"
            }
        }
        if (n && !(key in seen)) printf "circle:\n%s", text
        seen[key] = 1
        n = 0
    }
    /input contains a loop/ { end_of_circle(); next }
    { node[++n] = $2 }
    END { end_of_circle() }' "$work/arrows" "$work/loops" >"$work/circles"
cat "$work/upward" "$work/circles"
echo "$(wc -l <"$work/arrows") arrows, $(wc -l <"$work/upward") upward, $(grep -c circle: "$work/circles" || true) circles"
[ "$(wc -l <"$work/arrows")" -gt 100 ] && [ ! -s "$work/upward" ] && [ ! -s "$work/circles" ]
