#!/bin/sh
# usage: full_disk.sh COMMAND SCENE: what verbs that write a file do on disks of 8 KiB to 1 MiB: a sentence, exit status 5, and nothing left behind; or all
# is written. Needs root, which mounts the disks in a namespace of its own. Exit status 77: it cannot be tried here.
set -eu
command=$1 scene=$2
if [ "${3-}" != inside ]; then
    [ "$(id -u)" -eq 0 ] || { echo "skipped: only root makes small disks"; exit 77; }
    unshare --mount true 2>/dev/null || { echo "skipped: no right to mount"; exit 77; }
    exec unshare --mount "$0" "$command" "$scene" inside
fi
work=$(mktemp -d)
trap 'umount "$work/disk" 2>/dev/null || true; rm -rf "$work"' EXIT
mkdir "$work/disk"
"$command" thorax --simple --triangles 10000 -o "$work/thorax" --quiet
scan='Scan={"NumberOfProjections":60,"FinalAngle":360}'
failed=0
# try VERB... -o NAME: on a disk of $size
try() {
    for output; do :; done # the last word
    status=0
    "$command" "$@" --quiet >"$work/out" 2>"$work/err" </dev/null || status=$?
    left=$(ls -A "$work/disk")
    if [ $status -ne 0 ]; then
        [ $status -eq 5 ] && [ -z "$left" ] && grep -q 'cannot be written\|could not be written\|No space left' "$work/err" && return
    else
        [ -e "$output" ] && return
    fi
    echo "$size: $*: status $status, left: $left, said: $(tail -n 1 "$work/err")"
    failed=1
}
for size in 8k 16k 64k 1m; do
    for file in a.h5 a.mha a.tif a.raw; do
        mount -t tmpfs -o size=$size tmpfs "$work/disk"
        try scan "$scene" --set "$scan" -o "$work/disk/$file"
        umount "$work/disk"
    done
    for file in a.mha a.tif a.png; do
        mount -t tmpfs -o size=$size tmpfs "$work/disk"
        try image "$scene" -o "$work/disk/$file"
        umount "$work/disk"
    done
    mount -t tmpfs -o size=$size tmpfs "$work/disk"
    try mesh "$work/thorax/liver.ply" --fix -o "$work/disk/a.ply"
    umount "$work/disk"
    mount -t tmpfs -o size=$size tmpfs "$work/disk"
    try view "$scene" -o "$work/disk/a.png"
    umount "$work/disk"
    # Outputs of several files, in a folder that the command makes or that is there with a file of another.
    mount -t tmpfs -o size=$size tmpfs "$work/disk"
    try thorax --simple --triangles 10000 -o "$work/disk/thorax"
    umount "$work/disk"
    mount -t tmpfs -o size=$size tmpfs "$work/disk"
    try breathe "$work/thorax/thorax.json" --set "Detector.NumberOfPixels=[64,64]" --seconds 3 --fps 4 --range 0:8 \
        --meshes "$work/disk/meshes" -o "$work/disk/frames"
    umount "$work/disk"
done
# The page of cost has room for its table, but not for itself.
mount -t tmpfs -o size=16k tmpfs "$work/disk"
size=16k
try cost "$scene" --quick --within 1 -o "$work/disk/a.html"
umount "$work/disk"
exit $failed
