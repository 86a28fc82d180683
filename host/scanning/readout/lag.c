/* The lag of a detector: part of a frame's signal is found in later frames. */
#include "core/core.h"
#include "core/text.h"

#include <skiagraph/readout.h>

#include <inttypes.h>
#include <math.h>
#include <string.h>

enum { TERMS_MAX = 8 };

struct skg_lag {
    int64_t pixels, count;
    double share[TERMS_MAX], stays[TERMS_MAX]; /* stays: of what is held, from one frame to the next */
    double *held;                              /* [count][pixels] keV */
};

static skg_status check_terms(int64_t pixels, int64_t count, const double *terms) {
    double sum = 0;
    if (pixels < 1 || count < 1 || count > TERMS_MAX || !terms)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "lag: %" PRId64 " pixels and %" PRId64 " terms; give pixels, and 1 to %d terms",
                        pixels, count, TERMS_MAX);
    for (int64_t i = 0; i < count; i++) {
        if (!(terms[2 * i] >= 0) || !(terms[2 * i + 1] > 0 && isfinite(terms[2 * i + 1])))
            return skg_fail(SKG_ERR_ARGUMENT,
                            "lag: term %" PRId64
                            " has the share %g and %g frames; give 0 or more, and more than 0",
                            i, terms[2 * i], terms[2 * i + 1]);
        sum += terms[2 * i];
    }
    return sum < 1 ? SKG_OK
                   : skg_fail(SKG_ERR_ARGUMENT, "lag: the shares add up to %g; give less than 1", sum);
}

skg_status skg_lag_create(int64_t pixels, int64_t count, const double *terms, skg_lag **lag) {
    SKG_PLAIN;
    skg_lag *made = NULL;
    SKG_NEEDS(lag);
    *lag = NULL;
    SKG_TRY(check_terms(pixels, count, terms));
    SKG_TRY(skg_alloc(1, sizeof *made, "lag", &made));
    made->pixels = pixels, made->count = count;
    for (int64_t i = 0; i < count; i++)
        made->share[i] = terms[2 * i], made->stays[i] = exp(-1 / terms[2 * i + 1]);
    const skg_status status = skg_alloc(count * pixels, sizeof *made->held, "lag", &made->held);
    if (status != SKG_OK) skg_free(&made);
    *lag = made;
    return status;
}

void skg_lag_release(skg_lag **lag) {
    if (!lag || !*lag) return;
    skg_free(&(*lag)->held);
    skg_free(lag);
}

skg_status skg_lag_clear(skg_lag *lag) {
    SKG_NEEDS(lag);
    memset(lag->held, 0, (size_t)(lag->count * lag->pixels) * sizeof *lag->held);
    return SKG_OK;
}

/* What a pixel shows of a signal: what is not held, and what is set free of what was. */
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
        const double shown = pass(lag, i, factor * given);
        if (type == SKG_TYPE_FLOAT64)
            ((double *)result)[i] = shown;
        else
            ((float *)result)[i] = (float)shown;
    }
    return SKG_OK;
}
