/* Runs the self-tests of a device that a call needs, and remembers verdicts. */
#include "device/choice.h"
#include "device/device.h"
#include "device/self_tests.h"

#include <stdio.h>
#include <string.h>

_Static_assert(SKG_SELF_TESTS < 64, "each self-test has a bit of device->passed");

const char *skg_self_test_name(skg_self_test number) {
    static const char *const names[SKG_SELF_TESTS] = {
        [SKG_SELF_TEST_CORE] = "core",
        [SKG_SELF_TEST_COPIES] = "strategy copies",
        [SKG_SELF_TEST_TILES] = "strategy tiles",
        [SKG_SELF_TEST_ATOMICS] = "strategy atomics",
        [SKG_SELF_TEST_DOUBLE] = "precision double",
        [SKG_SELF_TEST_HALF] = "precision half",
        [SKG_SELF_TEST_ENERGIES] = "several energies",
        [SKG_SELF_TEST_SOURCE_PLANE] = "source plane",
        [SKG_SELF_TEST_LEAKY] = "leaky meshes",
        [SKG_SELF_TEST_PRIORITY] = "priority",
        [SKG_SELF_TEST_NOISE] = "noise",
        [SKG_SELF_TEST_BLUR] = "blur",
        [SKG_SELF_TEST_PARALLEL] = "parallel beam",
        [SKG_SELF_TEST_LENGTHS] = "path lengths",
        [SKG_SELF_TEST_DETECTOR] = "detector",
        [SKG_SELF_TEST_SHADES] = "shades",
        [SKG_SELF_TEST_PLACE] = "positions on the device",
        [SKG_SELF_TEST_PICTURE] = "3D view",
        [SKG_SELF_TEST_RAYS] = "supersampling",
        [SKG_SELF_TEST_HEEL] = "heel effect",
        [SKG_SELF_TEST_DEPTHS] = "blur by depths",
        [SKG_SELF_TEST_APART] = "noise power",
        [SKG_SELF_TEST_PASSES] = "extended source",
        [SKG_SELF_TEST_SIDE] = "extended source, side by side",
        [SKG_SELF_TEST_SCATTER] = "scatter",
        [SKG_SELF_TEST_GRADIENT] = "gradients",
        [SKG_SELF_TEST_VARIANCE] = "variance",
        [SKG_SELF_TEST_DENSITIES] = "density gradients",
        [SKG_SELF_TEST_VOLUME] = "volumes",
        [SKG_SELF_TEST_PULSES] = "photon counting",
        [SKG_SELF_TEST_LINEAR] = "linear volumes",
        [SKG_SELF_TEST_CELLS] = "volume gradients",
    };
    return names[number];
}

static skg_status refuse(const skg_device *device, skg_self_test number, const skg_verdict *verdict) {
    return skg_fail(SKG_ERR_DEVICE,
                    "%s (%s, driver %s) %s with the kernels of %s: %s. Choose another device, or update the "
                    "driver; `skiagraph devices --test` tests all",
                    device->info.name, device->info.platform_name, device->info.driver,
                    verdict->failed ? "fails" : "computes wrongly", skg_self_test_name(number),
                    verdict->reason);
}

/* The scenes of the self-tests are valid. If a call reports an error in one, it has read wrong numbers from the device. */
skg_status skg_self_test_run(skg_context *context, skg_self_test number, skg_verdict *verdict) {
    skg_device *device = context->device;
    *verdict = (skg_verdict){0};
    device->self_testing++;
    const skg_status status = skg_self_tests.run(context, number, verdict);
    device->self_testing--;
    if (status != SKG_ERR_MESH && status != SKG_ERR_SCENE) return status;
    *verdict = (skg_verdict){0};
    snprintf(verdict->reason, sizeof verdict->reason, "%s", skg_last_error());
    return SKG_OK;
}

skg_status skg_self_test_repeat(skg_context *context, skg_self_test number, skg_verdict *verdict) {
    skg_device *device = context->device;
    SKG_TRY(skg_self_test_run(context, number, verdict));
    skg_verdict_keep(device->store, &device->identity, skg_self_test_name(number), verdict);
    if (verdict->good && number == SKG_SELF_TEST_CORE && !device->info.known)
        skg_platform_trust(device->store, device->platform);
    if (verdict->good) device->passed |= UINT64_C(1) << number;
    return SKG_OK;
}

skg_status skg_self_test_need(skg_context *context, skg_self_test number) {
    skg_device *device = context->device;
    skg_verdict verdict;
    /* Kernels that are being developed are their author's own to test; a simulator is slow, and runs our own tests. */
    if (device->kernel_dir || device->simulates || device->self_testing || device->passed >> number & 1)
        return SKG_OK;
    if (!skg_verdict_known(device->store, &device->identity, skg_self_test_name(number), &verdict))
        SKG_TRY(skg_self_test_repeat(context, number, &verdict));
    if (!verdict.good) return refuse(device, number, &verdict);
    device->passed |= UINT64_C(1) << number;
    return SKG_OK;
}
