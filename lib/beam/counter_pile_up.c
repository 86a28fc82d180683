/* Pile-up of a detector that counts: what dead time leaves of pulses, and in which window sums of pulses are recorded. */
#include "beam/counter.h"
#include "core/text.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

SKG_DEFINE_PILE_UP(move_pulses, double, )

skg_status skg_pile_up_get(int32_t pile_up, double pulses, double *counted, double *fano) {
    SKG_PLAIN;
    SKG_NEEDS(counted);
    if (!(pulses >= 0 && isfinite(pulses)))
        return skg_fail(SKG_ERR_ARGUMENT, "%g pulses in a dead time; give 0 or more", pulses);
    if (pile_up < SKG_PILE_UP_NONE || pile_up > SKG_PILE_UP_PARALYSABLE)
        return skg_fail(SKG_ERR_ARGUMENT, "pile-up %" PRId32 " is no SKG_PILE_UP_ value", pile_up);
    const int nonparalysable = pile_up == SKG_PILE_UP_NONPARALYSABLE;
    const double left = pile_up == SKG_PILE_UP_NONE ? 1 : nonparalysable ? 1 / (1 + pulses) : exp(-pulses);
    *counted = pulses * left;
    if (fano) *fano = pile_up == SKG_PILE_UP_NONE ? 1 : nonparalysable ? left * left : 1 - 2 * *counted;
    return SKG_OK;
}

/* A sum is compared with a threshold once, with the noise of one pulse. A step stands for all heights that are nearest to it: an even
 * distribution, whose variance adds to that of the noise; without noise it is taken as it is. */
static double chance_below(double threshold, double height, double step, double noise) {
    const double over = threshold - height, width = sqrt(noise * noise + step * step / 12);
    if (noise > 0) return 0.5 * erfc(-over / (sqrt(2) * width));
    return fmin(fmax(over / step + 0.5, 0), 1);
}

void skg_pile_up_below(const skg_counting *c, double *below) {
    const double step = skg_pulse_step(c), noise = skg_pulse_noise(c);
    for (int64_t w = 0; w < c->count; w++)
        for (int j = 1; j <= SKG_PULSE_STEPS; j++)
            below[w * SKG_PULSE_STEPS + j - 1] =
                w ? chance_below(c->threshold_kev[w], j * step, step, noise) : 0;
}

void skg_counter_pile(const skg_counting *c, const double *heights, double *counts) {
    const int64_t windows = c->count;
    double all = 0, left = 0, below[SKG_THRESHOLDS_MAX * SKG_PULSE_STEPS], mixed[SKG_PULSE_STEPS] = {0};
    for (int64_t w = 0; w < windows; w++) all += counts[w];
    if (!c->pile_up || !(all > 0)) return;
    const double pulses = all * c->dead_time_ns * 1e-9 / c->exposure_s;
    for (int64_t w = 0; w < windows; w++) counts[w] /= all;
    if (skg_counting_moves(c)) {
        const double few = fmin(pulses, SKG_PULSES_MOST);
        skg_pile_up_below(c, below);
        for (int64_t w = 0; w < windows; w++)
            for (int j = 0; j < SKG_PULSE_STEPS; j++)
                mixed[j] += counts[w] * heights[w * SKG_PULSE_STEPS + j];
        move_pulses(c->pile_up == SKG_PILE_UP_PARALYSABLE, (int)windows, skg_pulse_first(c), few, exp(-few),
                    mixed, below, counts);
    } else if (skg_pile_up_get(c->pile_up, pulses, &left, NULL) == SKG_OK)
        counts[0] = left / pulses;
    for (int64_t w = 0; w < windows; w++) counts[w] *= all;
}

/* Adds the counts of an energy, and their heights. */
static void add_energy(const skg_counter *counter, const skg_counter_row *row, double photons, double *counts,
                       double *heights) {
    const int64_t windows = counter->counting.count;
    for (int64_t w = 0; w < windows; w++) counts[w] += photons * row->counts[w];
    for (int64_t w = 0; w < windows && skg_counting_moves(&counter->counting); w++)
        for (int j = 0; j < SKG_PULSE_STEPS; j++)
            heights[w * SKG_PULSE_STEPS + j] += photons * skg_counter_heights(counter, row, w)[j];
}

skg_status skg_counter_record(skg_counter *counter, int64_t count, const double *energy_kev,
                              const double *photons, double exposure, double *recorded) {
    const int64_t windows = counter->counting.count;
    const skg_counter_row **rows = NULL;
    double counts[SKG_THRESHOLDS_MAX] = {0}, heights[SKG_THRESHOLDS_MAX * SKG_PULSE_STEPS] = {0};
    SKG_TRY(skg_alloc(count, sizeof *rows, "counting detector", &rows));
    const skg_status status = skg_counter_rows_get(counter, count, energy_kev, rows);
    for (int64_t i = 0; i < count && status == SKG_OK; i++)
        add_energy(counter, rows[i], exposure * photons[i], counts, heights);
    skg_free(&rows);
    if (status != SKG_OK) return status;
    for (int64_t k = 0; k < windows * SKG_PULSE_STEPS; k++)
        heights[k] = counts[k / SKG_PULSE_STEPS] > 0 ? heights[k] / counts[k / SKG_PULSE_STEPS] : 0;
    skg_counter_pile(&counter->counting, heights, counts);
    memcpy(recorded, counts, (size_t)windows * sizeof *recorded);
    return SKG_OK;
}
