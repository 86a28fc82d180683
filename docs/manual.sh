#!/bin/sh
# manual.sh DOXYGEN DOXYFILE FOLDER: writes section 3 of the manual into FOLDER/man3: a page for each header, struct and function.
set -eu
doxygen=$1 doxyfile=$2 folder=$3
here=$(cd "$(dirname "$0")" && pwd)
quote=DoubleQuote
rm -rf "$folder"
mkdir -p "$folder/man3"
{
    cat "$doxyfile"
    echo "GENERATE_HTML = NO"
    echo "GENERATE_MAN = YES"
    echo "ALWAYS_DETAILED_SEC = YES"
    echo "OUTPUT_DIRECTORY = \"$folder\""
    echo "MAN_OUTPUT = made"
    # Doxygen would make single quotes of double ones.
    echo "INPUT_FILTER = \"awk -v quote=$quote -f $here/fields.awk\""
} | "$doxygen" -
for page in "$folder"/made/man3/*.3; do
    case $page in
    *.h.3) sed "s/$quote/\\\\(dq/g" "$page" | awk -f "$here/manual.awk" -v folder="$folder/man3" -v base="${page##*/}" ;;
    *)
        sed -e "s/$quote/\\\\(dq/g" -e '/^\.SH "Author"/,$d' -e "s/^'/\\\\\&'/" -e 's/^\(\.TH "[^"]*" 3\).*/\1 "" "Skiagraph" "Skiagraph"/' \
            "$page" >"$folder/man3/${page##*/}"
        ;;
    esac
done
# Functions name the page of their header, where what they have in common stands.
for page in "$folder"/man3/skg_*.3; do
    header=$(sed -n 's/^\\fC#include <skiagraph\/\([a-z_\\&.]*\)>\\fP$/\1/p' "$page" | sed 's/\\&//')
    printf '.SH "SEE ALSO"\n\\fBskiagraph_%s\\fP(3)\n' "$header" >>"$page"
done
rm -r "$folder/made"
