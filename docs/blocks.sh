#!/bin/sh
# The command lines of the documentation: README.md and docs/*.md.
#   blocks.sh list          every block of command lines is fenced as `sh run`, or as `sh` below a comment that says why it
#                           cannot be run; prints how many there are. Exit status 1 if there is another one.
#   blocks.sh run FOLDER    runs the blocks fenced as `sh run`, page by page, in FOLDER, a new copy of the project beside
#                           which ./demo has run: README.md, the installation and the first scene first, then the pages in
#                           the order of their names
set -eu
cd "$(dirname "$0")/.."
project=$PWD
case ${1-} in
list)
    awk '
    function bad(what) { print FILENAME ":" FNR ": " what; failed = 1 }
    /^ *```/ {
        if (inside) { inside = 0; next }
        inside = 1; kind = $0; sub(/^ *```/, "", kind)
        if (kind == "sh run") run++
        if (kind == "sh") {
            if (before ~ /^<!-- not run: .+ -->$/) { apart++; print FILENAME ":" FNR ": " before }
            else bad("a block `sh` without a line `<!-- not run: REASON -->` above it")
        }
        next
    }
    inside && kind == "sh run" && NF { lines++ }
    inside && kind == "" && /^(\.\/|cmake |ctest |skiagraph |pip |python3 |auditwheel |mpirun |apt-get |export |PATH=|bench)/ {
        bad("command lines in a block that is neither `sh run` nor `sh`")
    }
    !inside { before = $0 }
    END { printf "%d lines in %d blocks are run, %d blocks are not\n", lines, run, apart; exit failed }
    ' README.md docs/*.md
    ;;
run)
    mkdir -p "$2"
    tar -cf - --exclude='./build*' --exclude=./demo-pictures --exclude=./.git . | tar -xf - -C "$2"
    for made in build-release demo-pictures; do ln -s "$project/$made" "$2/$made"; done
    cd "$2"
    set -- README.md docs/install.md docs/first-scene.md
    for page in docs/*.md; do
        case " $* " in *" $page "*) ;; *) set -- "$@" "$page" ;; esac
    done
    for page; do
        awk '/^```/ { on = ($0 == "```sh run"); next } on' "$page" >blocks.txt
        [ -s blocks.txt ] || continue
        echo "$page: $(grep -c . blocks.txt) lines"
        PATH=$project/build-release/bin:$PATH sh -eux blocks.txt >blocks.log 2>&1 </dev/null || {
            tail -n 40 blocks.log
            echo "The line above of $page failed."
            exit 1
        }
    done
    ;;
*)
    sed -n '2,8s/^# //p' "$0"
    exit 2
    ;;
esac
