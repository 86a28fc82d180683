/* The lag of a detector: part of a frame's signal is found in later frames. */
#include "core/core.h"
#include "core/text.h"

#include <skiagraph/readout.h>

#include <inttypes.h>
#include <math.h>
#include <string.h>

enum { TERMS_MAX = 8 };

struct skg_lag {
    int64_t pixels, count, ghosts;
    double share[TERMS_MAX], stays[TERMS_MAX]; /* stays: of what is held, from one frame to the next */
    /* of the sensitivity; keeps: of what was received, likewise */
    double change[TERMS_MAX], keeps[TERMS_MAX];
    double full;
    double *held;     /* [count][pixels] keV */
    double *received; /* [ghosts][pixels] mean of late frames, over the open beam */
};

/* least: of a share. what: "share" or "change of the sensitivity" */
static skg_status check_terms(const char *what, double least, int64_t fewest, int64_t count,
                              const double *terms, double *sum) {
    *sum = 0;
    if (count < fewest || count > TERMS_MAX || (count > 0 && !terms))
        return skg_fail(SKG_ERR_ARGUMENT, "lag: %" PRId64 " terms of a %s; give %" PRId64 " to %d", count,
                        what, fewest, TERMS_MAX);
    for (int64_t i = 0; i < count; i++) {
        if (!(terms[2 * i] >= least && isfinite(terms[2 * i])) ||
            !(terms[2 * i + 1] > 0 && isfinite(terms[2 * i + 1])))
            return skg_fail(SKG_ERR_ARGUMENT,
                            "lag: term %" PRId64
                            " has the %s %g and %g frames; give %g or more, and more than 0",
                            i, what, terms[2 * i], terms[2 * i + 1], least);
        *sum += terms[2 * i];
    }
    return SKG_OK;
}

skg_status skg_lag_create(int64_t pixels, int64_t count, const double *terms, skg_lag **lag) {
    SKG_PLAIN;
    skg_lag *made = NULL;
    double sum = 0;
    SKG_NEEDS(lag);
    *lag = NULL;
    if (pixels < 1) return skg_fail(SKG_ERR_ARGUMENT, "lag: %" PRId64 " pixels; give 1 or more", pixels);
    SKG_TRY(check_terms("share", 0, 0, count, terms, &sum));
    if (!(sum < 1)) return skg_fail(SKG_ERR_ARGUMENT, "lag: the shares add up to %g; give less than 1", sum);
    SKG_TRY(skg_alloc(1, sizeof *made, "lag", &made));
    made->pixels = pixels, made->count = count;
    for (int64_t i = 0; i < count; i++)
        made->share[i] = terms[2 * i], made->stays[i] = exp(-1 / terms[2 * i + 1]);
    const skg_status status = skg_alloc(count * pixels, sizeof *made->held, "lag", &made->held);
    if (status != SKG_OK) skg_free(&made);
    *lag = made;
    return status;
}

skg_status skg_lag_ghosting_set(skg_lag *lag, double full, int64_t count, const double *terms) {
    SKG_PLAIN;
    double sum = 0, *received = NULL;
    SKG_NEEDS(lag);
    if (!(full > 0) || !isfinite(full))
        return skg_fail(SKG_ERR_ARGUMENT, "lag: the open beam is %g; give a signal above 0", full);
    SKG_TRY(check_terms("change of the sensitivity", -1, 1, count, terms, &sum));
    if (!(sum > -1))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "lag: the changes of the sensitivity add up to %g; give more than -1", sum);
    SKG_TRY(skg_alloc(count * lag->pixels, sizeof *received, "lag", &received));
    skg_free(&lag->received);
    lag->received = received, lag->ghosts = count, lag->full = full;
    for (int64_t i = 0; i < count; i++)
        lag->change[i] = terms[2 * i], lag->keeps[i] = exp(-1 / terms[2 * i + 1]);
    return SKG_OK;
}

void skg_lag_release(skg_lag **lag) {
    if (!lag || !*lag) return;
    skg_free(&(*lag)->held);
    skg_free(&(*lag)->received);
    skg_free(lag);
}

skg_status skg_lag_clear(skg_lag *lag) {
    SKG_NEEDS(lag);
    memset(lag->held, 0, (size_t)(lag->count * lag->pixels) * sizeof *lag->held);
    if (lag->received) memset(lag->received, 0, (size_t)(lag->ghosts * lag->pixels) * sizeof *lag->received);
    return SKG_OK;
}

/* Signal of a pixel with the sensitivity that earlier signals left it. */
static double sense(skg_lag *lag, int64_t pixel, double signal) {
    double sensitivity = 1;
    for (int64_t k = 0; k < lag->ghosts; k++) {
        double *received = &lag->received[k * lag->pixels + pixel];
        sensitivity += lag->change[k] * *received;
        *received += (1 - lag->keeps[k]) * (signal / lag->full - *received);
    }
    return signal * fmax(sensitivity, 0);
}

/* Shown signal of a pixel: the share that is not trapped, and the charge that traps release. */
static double pass(skg_lag *lag, int64_t pixel, double signal) {
    double shown = signal;
    for (int64_t k = 0; k < lag->count; k++) {
        double *held = &lag->held[k * lag->pixels + pixel];
        const double caught = lag->share[k] * signal;
        shown += *held * (1 - lag->stays[k]) - caught;
        *held = *held * lag->stays[k] + caught;
    }
    return shown;
}

skg_status skg_lag_apply(skg_lag *lag, int32_t type, const void *energies, double factor, void *result) {
    SKG_PLAIN;
    SKG_NEEDS(lag);
    SKG_NEEDS(result);
    if (type != SKG_TYPE_FLOAT32 && type != SKG_TYPE_FLOAT64)
        return skg_fail(SKG_ERR_ARGUMENT, "lag: type %" PRId32 "; SKG_TYPE_FLOAT32 or SKG_TYPE_FLOAT64",
                        type);
    for (int64_t i = 0; i < lag->pixels; i++) {
        const double given = !energies                  ? 0
                             : type == SKG_TYPE_FLOAT64 ? ((const double *)energies)[i]
                                                        : (double)((const float *)energies)[i];
        const double shown = pass(lag, i, sense(lag, i, factor * given));
        if (type == SKG_TYPE_FLOAT64)
            ((double *)result)[i] = shown;
        else
            ((float *)result)[i] = (float)shown;
    }
    return SKG_OK;
}
