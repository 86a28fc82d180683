#!/bin/sh
# Runs failing_test and compares the places that it made to fail with all calls of the library that can fail, as the
# disassembled program has them. usage: failing.sh PROGRAM FOLDER OBJDUMP NM ADDR2LINE
# Fails on a place that no run reaches, and on an OpenCL function that the library calls and failing_wrap.cmake lacks.
set -eu
program=$1 folder=$2 objdump=$3 nm=$4 addr2line=$5
export LC_ALL=C SKG_SITES="$folder/failing_sites.txt"
rm -f "$SKG_SITES"
"$program"
cd "$folder"

# The library's sources, not those of the tests or of libraries that are linked in.
ours='/\(lib\|host\|materials\)/[a-z0-9/]*/[a-z0-9_]*\.c:'

# Made once in a process, before calls are counted; sub_device_test makes it fail.
once='/driver/sub_devices.c:'

# Of each call that can fail: the address to which it returns. Absolute, as the program's file has them.
"$objdump" -d --no-show-raw-insn "$program" | awk '
    found { sub(":", "", $1); print $1; found = 0 }
    /<__wrap_[A-Za-z_]*>$/ && !/^[0-9a-f]+ </ && !/__wrap_(clRelease|clRetain|clEnqueueUnmap|free|json_)/ { found = 1 }' | sort -u >failing_calls.txt
start=$("$nm" "$program" | sed -n 's/ . __executable_start$//p')
while read -r site; do
    [ ${#site} -gt 10 ] || printf '%x\n' $((0x$site + 0x${start:-0})) # longer ones lie in other libraries
done <"$SKG_SITES" | sort -u >failing_reached.txt

comm -23 failing_calls.txt failing_reached.txt | while read -r address; do
    # one byte before the return address is the call
    printf '%x\n' $((0x$address - 1))
done | "$addr2line" -e "$program" | { grep "$ours" || true; } | { grep -v "$once" || true; } >failing_missed.txt
known=$("$addr2line" -e "$program" <failing_reached.txt | grep -c "$ours" || true)
echo "$known calls of the library were made to fail, $(wc -l <failing_missed.txt) were not"
if [ "$known" -lt 40 ]; then
    echo "skipped: the program has no debug information, so that its calls cannot be compared"
    exit 77
fi

# Calls that give back, retain or report do not fail.
"$nm" -u "$program" | sed -n 's/^ *U \(cl[A-Z][A-Za-z]*\).*/\1/p' | sort -u >failing_imports.txt
"$nm" "$program" | sed -n 's/.* [Tt] __wrap_\(cl[A-Z][A-Za-z]*\)$/\1/p' | sort -u >failing_wrapped.txt
comm -23 failing_imports.txt failing_wrapped.txt |
    { grep -v '^clRetain\|^clRelease\|^clGetProgramBuildInfo$' || true; } >failing_unwrapped.txt
cat failing_missed.txt failing_unwrapped.txt
[ ! -s failing_missed.txt ] && [ ! -s failing_unwrapped.txt ]
