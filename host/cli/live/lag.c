/* The lag of the scene's detector in the frames of a page: the ghost of an earlier view fades over the next frames. */
#include "live/lag.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Frames follow until no value differs from a steady one by more than this share of the range of values: a quarter of a grey level of 8
 * bits. */
static const double SETTLED = 1.0 / 1024;

void live_lag_free(live_lag *lag) {
    skg_lag_release(&lag->lag);
    *lag = (live_lag){.lag = NULL};
}

int live_lag_changes(const live_lag *lag) {
    return lag->lag && !lag->is_settled;
}

/* Begins anew if the detector is another one. */
static skg_status follow(live_lag *lag, const live_scene *scene, int64_t count) {
    const int32_t quantity = scene->wish.says.quantity;
    skg_readout readout;
    skg_readout_init(&readout);
    const skg_status status = skg_setup_readout_get(scene->setup, &readout);
    if (status != SKG_OK) return status;
    const size_t size = 2 * (size_t)readout.lag_count * sizeof *lag->terms;
    if (lag->lag && lag->values == count && lag->quantity == quantity && lag->count == readout.lag_count &&
        memcmp(lag->terms, readout.lag, size) == 0)
        return SKG_OK;
    live_lag_free(lag);
    if (readout.lag_count == 0) return SKG_OK;
    lag->values = count, lag->quantity = quantity, lag->count = readout.lag_count;
    memcpy(lag->terms, readout.lag, size);
    return skg_lag_create(count, readout.lag_count, readout.lag, &lag->lag);
}

/* Adds held signal to transmissions, which it is a share of as of signals, since a pixel's flat field is the same in all frames. */
static skg_status show(live_lag *lag, float *values) {
    const int is_log = lag->quantity == SKG_QUANTITY_ATTENUATION;
    float *shown = malloc((size_t)lag->values * sizeof *shown), low = HUGE_VALF, high = -HUGE_VALF, off = 0;
    if (!shown) return SKG_ERR_MEMORY;
    for (int64_t i = 0; i < lag->values; i++) {
        if (is_log) values[i] = expf(-values[i]);
        low = fminf(low, values[i]), high = fmaxf(high, values[i]);
    }
    const skg_status status = skg_lag_apply(lag->lag, SKG_TYPE_FLOAT32, values, 1, shown);
    for (int64_t i = 0; i < lag->values && status == SKG_OK; i++) {
        off = fmaxf(off, fabsf(shown[i] - values[i]));
        values[i] = is_log ? -logf(fmaxf(shown[i], FLT_MIN)) : shown[i];
    }
    lag->is_settled = (double)off <= SETTLED * (double)(high - fminf(low, 0));
    free(shown);
    return status;
}

int live_lag_show(live_lag *lag, const live_scene *scene, const skg_live_frame *frame, char *sentence) {
    skg_status status = follow(lag, scene, frame->channels * frame->columns * frame->rows);
    if (status == SKG_OK && lag->lag) status = show(lag, frame->values);
    if (status == SKG_OK) return 1;
    snprintf(sentence, LIVE_SENTENCE, "%s",
             status == SKG_ERR_MEMORY ? "out of host memory for the lag" : skg_last_error());
    return 0;
}
