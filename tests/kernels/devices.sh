#!/bin/sh
# devices.sh BUILD INTEL: runs the suites of the kernels on every OpenCL device, and prints what each of them says. INTEL is yes
# to install Intel's CPU runtime first, into BUILD/intel: a second implementation of OpenCL, independent of PoCL. Exit status 1
# if a suite fails on a device that computes rightly. A device that computes wrongly is refused by the library, and is named.
# Mesa's Rusticl on llvmpipe, where it is installed, is such a device.
set -eu
export RUSTICL_ENABLE="${RUSTICL_ENABLE:-llvmpipe}"
build=$1 intel=$2
bin=$build/bin
export SKG_CACHE_DIR="$build/program-cache" POCL_CACHE_DIR="$build/kernel-cache" CK_DEFAULT_TIMEOUT=1200
if [ "$intel" = yes ]; then
    if [ ! -e "$build/intel/vendors/intel.icd" ]; then
        python3 -m venv "$build/intel"
        "$build/intel/bin/pip" install --quiet intel-opencl-rt intel-cmplr-lib-rt
        mkdir -p "$build/intel/vendors"
        echo "$build/intel/lib/libintelocl.so" >"$build/intel/vendors/intel.icd"
    fi
    # The loader reads one folder: the system's drivers are named there, too.
    for icd in /etc/OpenCL/vendors/*.icd; do
        [ ! -e "$icd" ] || cp "$icd" "$build/intel/vendors"
    done
    export OCL_ICD_VENDORS="$build/intel/vendors" LD_LIBRARY_PATH="$build/intel/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
fi
"$bin/skiagraph" devices --test | tee "$build/devices.txt"
failed=0
# shellcheck disable=SC2013 # a word a line
for number in $(sed -n 's/^\([0-9]*:[0-9]*\)  .*/\1/p' "$build/devices.txt"); do
    if ! SKG_DEVICE=$number "$bin/skiagraph" devices >/dev/null 2>"$build/devices.log"; then
        echo "$number is refused:"
        cat "$build/devices.log"
        continue
    fi
    for suite in raster_test exponential_test blur_test random_test layout_test lengths_test polychromatic_test priority_test; do
        if SKG_DEVICE=$number "$bin/$suite" >"$build/devices.log" 2>&1; then
            echo "$number: $suite passed"
        else
            failed=1
            echo "$number: $suite failed"
            cat "$build/devices.log"
        fi
    done
done
exit $failed
