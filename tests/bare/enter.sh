#!/bin/sh
# usage: enter.sh WORK SHARED FULL SOURCE..., in a namespace of its own for mounts and processes. Fills WORK/root from the
# sources of packages, moves WORK/project into it, and runs inside.sh there. SHARED: the folder of measured data, if any.
set -eu
work=$1 shared=$2 full=$3
shift 3
root=$work/root
began=$(date +%s)
export TMPDIR="$work"
mmdebstrap --quiet --variant=apt bookworm "$root" "$@" || { echo "mmdebstrap failed" >&2; exit 3; }
mount -t proc proc "$root/proc"
mount --rbind /sys "$root/sys" # PoCL reads the processors there
mount --rbind /dev "$root/dev"
mount -t tmpfs tmpfs "$root/dev/shm" 2>/dev/null || true

# The way to the registries of packages. Only settings are taken over: hooks name programs that are not there.
for file in resolv.conf hosts; do [ ! -e /etc/$file ] || cp -L /etc/$file "$root/etc/$file"; done
apt-config dump | grep -E '^Acquire::(http|https|Check|Retries)' >"$root/etc/apt/apt.conf.d/00machine" || true
mkdir -p "$root/etc/ssl"
for file in /etc/ssl/certs/ca-certificates.crt ${SSL_CERT_FILE-} ${PIP_CERT-}; do
    [ ! -e "$file" ] || cp -L "$file" "$root/etc/ssl/machine.crt"
done
echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/fast" # nobody needs this folder after a power failure
{
    echo "[global]"
    [ ! -e "$root/etc/ssl/machine.crt" ] || echo "cert = /etc/ssl/machine.crt"
    python3 -m pip config list 2>/dev/null |
        sed -n "s/^\(global\|:env:\)\.\(index-url\|extra-index-url\|proxy\|trusted-host\)='\(.*\)'\$/\2 = \3/p" | sort -u
} >"$root/etc/pip.conf"

mv "$work/project" "$root/root/project"
if [ -d "$shared/data" ]; then
    mkdir "$root/root/shared"
    mount --bind "$shared" "$root/root/shared"
    mount -o remount,bind,ro "$root/root/shared"
fi
echo "A bare Debian 12: $(($(date +%s) - began)) s"
status=0
# A background process of a shell ignores these signals, and so would everything inside.
env -i --default-signal=INT,QUIT HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
    LANG=C.UTF-8 CI="${CI:-true}" chroot "$root" sh /root/project/tests/bare/inside.sh "$full" || status=$?
if [ -n "${SKG_TALLY-}" ] && [ -e "$root/root/tally" ]; then cat "$root/root/tally" >>"$SKG_TALLY"; fi
exit $status
