#include "trial/trial.h"
#include "device/device.h"
#include "device/platforms.h"
#include "device/verdict.h"
#include "trial/exact.h"
#include "trial/picture.h"

#include <stdio.h>
#include <string.h>

_Static_assert(SKG_TRIALS < 64, "each test has a bit of device->passed");

/* What is kept of a finding. */
static skg_verdict verdict_of(const skg_finding *finding) {
    skg_verdict verdict = {.good = finding->good, .score = finding->score};
    snprintf(verdict.reason, sizeof verdict.reason, "%s", finding->reason);
    return verdict;
}

static skg_status refuse(const skg_device *device, skg_trial_number number, const skg_verdict *verdict) {
    return skg_fail(SKG_ERR_DEVICE,
                    "%s (%s, driver %s) %s with the kernels of %s: %s. Choose another device, or update the "
                    "driver; `skiagraph devices --test` tests all",
                    device->info.name, device->info.platform_name, device->info.driver,
                    verdict->failed ? "fails" : "computes wrongly", skg_trial_get(number)->name,
                    verdict->reason);
}

static skg_status run_test(skg_context *context, skg_trial_number number, skg_finding *finding) {
    switch (number) {
    case SKG_TRIAL_PARALLEL:
        return skg_exact_judge(context, finding);
    case SKG_TRIAL_PICTURE:
        return skg_picture_judge(context, finding);
    default:
        return skg_trial_judge(context, number, finding);
    }
}

/* The scenes of the tests are usable. A call that finds one unusable has read wrong numbers from the device. */
skg_status skg_trial_run(skg_context *context, skg_trial_number number, skg_finding *finding) {
    const skg_status status = run_test(context, number, finding);
    if (status != SKG_ERR_MESH && status != SKG_ERR_SCENE) return status;
    *finding = (skg_finding){0};
    snprintf(finding->reason, sizeof finding->reason, "%s", skg_last_error());
    return SKG_OK;
}

skg_status skg_trial_again(skg_context *context, skg_trial_number number, skg_finding *finding) {
    skg_device *device = context->device;
    SKG_TRY(skg_trial_run(context, number, finding));
    const skg_verdict verdict = verdict_of(finding);
    skg_verdict_keep(device->store, &device->identity, skg_trial_get(number)->name, &verdict);
    if (finding->good && number == SKG_TRIAL_CORE && !device->info.known)
        skg_platform_trust(device->store, device->platform);
    if (finding->good) device->passed |= UINT64_C(1) << number;
    return SKG_OK;
}

skg_status skg_trial_need(skg_context *context, skg_trial_number number) {
    skg_device *device = context->device;
    skg_verdict known;
    skg_finding finding;
    /* Kernels that are being developed are their author's own to test; a simulator is slow, and runs our own tests. */
    if (device->kernel_dir || device->simulates || device->passed >> number & 1) return SKG_OK;
    if (skg_verdict_known(device->store, &device->identity, skg_trial_get(number)->name, &known)) {
        if (!known.good) return refuse(device, number, &known);
        device->passed |= UINT64_C(1) << number;
        return SKG_OK;
    }
    SKG_TRY(skg_trial_again(context, number, &finding));
    if (finding.good) return SKG_OK;
    known = verdict_of(&finding);
    return refuse(device, number, &known);
}
