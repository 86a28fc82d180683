#!/bin/sh
# maps.sh HOUSE ROOT: fails if a room is missing in the table of docs/architecture.md, if docs/architecture.svg is
# not the drawing of these rooms, or if a public header is missing in docs/interface.md.
set -eu
house=$1 root=$2 status=0
drawing=$(mktemp)
trap 'rm -f "$drawing"' EXIT
awk -f "$root/docs/figures/architecture.awk" "$house" "$root/docs/architecture.md" >"$drawing" || status=1
if ! cmp -s "$drawing" "$root/docs/architecture.svg"; then
    echo "docs/architecture.svg is not the drawing of these rooms; make it again:"
    echo "    awk -f docs/figures/architecture.awk $house docs/architecture.md >docs/architecture.svg"
    status=1
fi
rooms=$(awk -v root="$root/" '$1 == "room" && index($3, root) == 1 { print substr($3, length(root) + 1) }' "$house")
for room in $rooms; do
    case $room in
    */include/skiagraph)
        for header in "$root/$room"/*.h "$root/$room"/*.hpp; do
            name=$(basename "$header")
            case $name in skiagraph.h | '*.hpp') continue ;; esac
            grep -qwF "$name" "$root/docs/interface.md" || { echo "docs/interface.md does not name $room/$name"; status=1; }
        done
        ;;
    esac
done
# Rooms that are gone must not be named any more.
# shellcheck disable=SC2013,SC2016 # a word a line; a pattern
for room in $(sed -n '/^### Each room/,/^Which room/s/^| `\([a-z/]*\)` | .*/\1/p' "$root/docs/architecture.md"); do
    echo "$rooms" | grep -qxF "$room" || { echo "docs/architecture.md names $room, which is no room"; status=1; }
done
# A frame knows nothing of derivatives: they are a kind of job of a room above.
if grep -rniE 'gradient|derivative' "$root/lib/frame"; then
    echo "lib/frame names derivatives, which are lib/gradient's"
    status=1
fi
# A source begins with a sentence that says what it does.
cd "$root"
for file in $(find lib host kernels tests bench materials examples python -name '*.c' -o -name '*.cl' -o -name '*.clh' -o -name '*.py' | grep -v '/build/\|/venv/'); do
    case $file in *.py) begins='^("""|r"""|# [A-Za-z`])' ;; *) begins='^/\* *[A-Za-z0-9`$-]' ;; esac
    sed -n '/^#!/d;/./{p;q;}' "$file" | grep -qE "$begins" || { echo "$file begins without a sentence"; status=1; }
done
# A declaration stands on one line: clang-format tears one whose comment behind it is too long for the line.
# shellcheck disable=SC2046 # a word a file
torn=$(awk 'FNR == 1 { before = "" }
    before ~ /^ +((const|struct|static|unsigned|volatile) )*[a-z_0-9]+( \*+)?$/ && before !~ /^ +(else|do|return|break)$/ &&
        /^ +\**[a-zA-Z_0-9]+(\[|;|,)/ { print FILENAME ":" FNR }
    before ~ /^ +(const )?[a-z_0-9]+ \*?[a-z_]+(\[[^]]*\])?,$/ && /^ +\**[a-z_]+(\[[^]]*\])?; *\/\*/ { print FILENAME ":" FNR }
    { before = $0 }' $(find lib host kernels tests bench examples -name '*.[ch]'))
[ -z "$torn" ] || { echo "Torn declarations; put the comment above them: $torn"; status=1; }
# A file that a comment names by its folder is there.
sources=$(find lib host kernels tests bench materials examples python docs -type f -not -path '*/build/*')
# shellcheck disable=SC2046 # a word a file
named=$(echo "$sources" | awk 'FILENAME == "-" { for (name = $0; ; sub(/^[^\/]*\//, "", name)) { there[name]; if (name !~ /\//) next } }
    /#include/ { next }
    { gsub(/%s\//, "") }
    { for (line = $0; match(line, /[a-z_]+(\/[a-z_0-9]+)*\/[a-z_0-9]+\.(clh|cl|c|h)[^a-z_0-9]/); line = substr(line, RSTART + RLENGTH)) {
        name = substr(line, RSTART, RLENGTH - 1)
        if (!(name in there) && name !~ /^skiagraph\//) print FILENAME ":" FNR " " name
    } }' - $(echo "$sources" | grep -E '^(lib|host|kernels|tests|bench)/.*\.(c|h|cl|clh)$'))
[ -z "$named" ] || { echo "These files are named and are not there:"; echo "$named"; status=1; }
# A comment begins with the thing that it is about.
# shellcheck disable=SC2046 # a word a file
pronouns=$(awk -f tests/house/openings.awk $(find lib host kernels tests bench materials examples python docs cmake -type f \
    \( -name '*.[ch]' -o -name '*.cl' -o -name '*.clh' -o -name '*.hpp' -o -name '*.py' -o -name '*.js' -o -name '*.sh' -o -name '*.awk' -o \
    -name '*.cmake' -o -name CMakeLists.txt \) | grep -v '/build/\|/venv/'))
[ -z "$pronouns" ] || { echo "These comments begin with a word that names nothing; say what they are about:"; echo "$pronouns"; status=1; }
# Structs of at most 40 members; more have a reason in structs.txt.
# shellcheck disable=SC2013,SC2046 # a word a file and a line
for struct in $(awk -v most=40 -f tests/house/structs.awk $(find lib host kernels bench tests -name '*.[ch]') | awk '{ print $2 }'); do
    grep -q "^$struct " tests/house/structs.txt || { echo "$struct has more than 40 members, and no reason in tests/house/structs.txt"; status=1; }
done
exit $status
