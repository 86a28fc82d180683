/* Detectors that count photons: checks, and tables of what they count by energy. */
#include "beam/counter.h"
#include "core/text.h"
#include "core/threads.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Below this many standard deviations of a pulse's noise, noise alone would be counted. */
static const double LEAST_THRESHOLD = 4;

void skg_counting_init_sized(void *counting, int32_t size) {
    const skg_counting defaults = {0};
    skg_struct_init(counting, size, &defaults, sizeof defaults);
}

static skg_status check_length(const char *what, double mm, int zero_is_fine) {
    if (isfinite(mm) && (mm > 0 || (zero_is_fine && mm == 0))) return SKG_OK;
    return skg_fail(SKG_ERR_BEAM, "counting detector: %s of %g mm; give %s", what, mm,
                    zero_is_fine ? "0 or more" : "more than 0");
}

static skg_status check_switch(const char *what, int32_t flag) {
    if (flag == 0 || flag == 1) return SKG_OK;
    return skg_fail(SKG_ERR_BEAM, "counting detector: %s is %" PRId32 "; 1 or 0", what, flag);
}

static skg_status check_thresholds(const skg_counting *c) {
    const double noise = skg_pulse_noise(c);
    if (c->count < 1 || c->count > SKG_THRESHOLDS_MAX || !c->threshold_kev)
        return skg_fail(SKG_ERR_BEAM, "counting detector: %" PRId64 " thresholds; give 1 to %d", c->count,
                        (int)SKG_THRESHOLDS_MAX);
    if (!(isfinite(c->electronic_kev) && c->electronic_kev >= 0))
        return skg_fail(SKG_ERR_BEAM, "counting detector: electronic noise of %g keV; give 0 or more",
                        c->electronic_kev);
    for (int64_t t = 0; t < c->count; t++)
        if (!(isfinite(c->threshold_kev[t]) && c->threshold_kev[t] > (t ? c->threshold_kev[t - 1] : 0)))
            return skg_fail(SKG_ERR_BEAM,
                            "counting detector: threshold %" PRId64 " is %g keV; thresholds are above 0 and "
                            "rise",
                            t + 1, c->threshold_kev[t]);
    if (c->threshold_kev[0] < LEAST_THRESHOLD * noise)
        return skg_fail(
            SKG_ERR_BEAM,
            "counting detector: the threshold of %g keV is %.3g standard deviations of a pulse's "
            "noise (%g keV%s), so that noise alone would be counted, which is not simulated; give "
            "at least %g keV",
            c->threshold_kev[0], c->threshold_kev[0] / noise, noise,
            c->anti_coincidence ? ", that of four pixels" : "", LEAST_THRESHOLD * noise);
    return SKG_OK;
}

static skg_status check_pile_up(const skg_counting *c) {
    if (c->pile_up < SKG_PILE_UP_NONE || c->pile_up > SKG_PILE_UP_PARALYSABLE)
        return skg_fail(SKG_ERR_BEAM, "counting detector: pile-up %" PRId32 " is no SKG_PILE_UP_ value",
                        c->pile_up);
    if (c->pile_up == SKG_PILE_UP_NONE) {
        if (c->dead_time_ns == 0) return SKG_OK;
        return skg_fail(SKG_ERR_BEAM, "counting detector: a dead time of %g ns, but pile-up is not asked for",
                        c->dead_time_ns);
    }
    if (!(isfinite(c->dead_time_ns) && c->dead_time_ns > 0))
        return skg_fail(SKG_ERR_BEAM,
                        "counting detector: a dead time of %g ns; give more than 0, or no pile-up",
                        c->dead_time_ns);
    if (!(isfinite(c->exposure_s) && c->exposure_s > 0))
        return skg_fail(SKG_ERR_BEAM,
                        "counting detector: with pile-up the rate of the photons counts, but the exposure is "
                        "%g s; give more than 0",
                        c->exposure_s);
    return SKG_OK;
}

static skg_status check_counting(const skg_counting *c) {
    double density = 0;
    SKG_TRY(check_length("a thickness", c->thickness_mm, 0));
    SKG_TRY(check_length("a pixel", c->pixel_mm[0], 0));
    SKG_TRY(check_length("a pixel", c->pixel_mm[1], 0));
    SKG_TRY(check_length("a charge cloud", c->cloud_mm, 1));
    if (!(isfinite(c->bias_v) && c->bias_v >= 0))
        return skg_fail(SKG_ERR_BEAM,
                        "counting detector: a bias of %g V; give more than 0, or 0 for charge that does not "
                        "spread on its way",
                        c->bias_v);
    const double width = skg_cloud_width(c, 0), pitch = fmin(c->pixel_mm[0], c->pixel_mm[1]);
    if (!(width <= pitch / 2))
        return skg_fail(
            SKG_ERR_BEAM,
            "counting detector: the charge's cloud has a standard deviation of up to %.3g mm, more "
            "than half a pixel of %g mm; give a higher bias, a thinner sensor or larger pixels",
            width, pitch);
    SKG_TRY(check_switch("fluorescence", c->fluorescence));
    SKG_TRY(check_switch("anti_coincidence", c->anti_coincidence));
    SKG_TRY(check_thresholds(c));
    SKG_TRY(check_pile_up(c));
    if (!c->material)
        return skg_fail(SKG_ERR_BEAM, "counting detector: the sensor has no material; give one, as CdTe");
    SKG_TRY(skg_material_density_get(c->material, &density));
    if (density > 0) return SKG_OK;
    return skg_material_attenuation_get(c->material, 60,
                                        &density); /* fails with the sentence on the density */
}

skg_status skg_counter_create(const skg_counting *counting, skg_counter **counter) {
    SKG_PLAIN;
    skg_counting ours;
    skg_counter *made = NULL;
    skg_status status = SKG_OK;
    SKG_NEEDS(counter);
    *counter = NULL;
    skg_counting_init(&ours);
    SKG_TRY(skg_struct_read(counting, "skg_counting", &ours, sizeof ours));
    SKG_TRY(check_counting(&ours));
    SKG_TRY(skg_alloc(1, sizeof *made, "counting detector", &made));
    skg_refs_init(&made->refs);
    pthread_mutex_init(&made->lock, NULL);
    memcpy(made->thresholds, ours.threshold_kev, (size_t)ours.count * sizeof *made->thresholds);
    made->counting = ours;
    made->counting.threshold_kev = made->thresholds;
    skg_material_retain(ours.material);
    made->material = ours.material;
    SKG_TRY_CLEANUP(skg_sensor_create(made->material, &made->counting, &made->sensor));
    *counter = made;
    return SKG_OK;
cleanup:
    skg_counter_release(&made);
    return status;
}

skg_status skg_counter_retain(skg_counter *counter) {
    SKG_NEEDS(counter);
    skg_ref(&counter->refs);
    return SKG_OK;
}

static void release_row(skg_counter_row **row) {
    if (*row) skg_free(&(*row)->counts);
    skg_free(row);
}

void skg_counter_release(skg_counter **counter) {
    if (!counter || !*counter) return;
    if (skg_unref(&(*counter)->refs)) {
        for (int64_t r = 0; r < (*counter)->row_count; r++) release_row(&(*counter)->rows[r]);
        skg_free(&(*counter)->rows);
        skg_sensor_release(&(*counter)->sensor);
        skg_material_release(&(*counter)->material);
        pthread_mutex_destroy(&(*counter)->lock);
        skg_free(counter);
    }
    *counter = NULL;
}

/* --- rows */

/* The detector looks the same along each direction and against it, as the histories do not quite: means over the four mirror images. */
static void mirror(double table[SKG_COUNTING_PIXELS]) {
    const int side = SKG_COUNTING_SIDE;
    for (int j = 0; j <= side / 2; j++)
        for (int i = 0; i <= side / 2; i++) {
            const int at[4] = {j * side + i, j * side + side - 1 - i, (side - 1 - j) * side + i,
                               (side - 1 - j) * side + side - 1 - i};
            const double mean = (table[at[0]] + table[at[1]] + table[at[2]] + table[at[3]]) / 4;
            for (int k = 0; k < 4; k++) table[at[k]] = mean;
        }
}

static skg_status make_row(const skg_counter *counter, double kev, skg_counter_row **row) {
    const int64_t windows = counter->counting.count, size = skg_counter_row_size(&counter->counting);
    const int64_t tables = skg_counter_tables_size(windows);
    skg_arrival *arrival = NULL;
    skg_deposit deposits[SKG_DEPOSITS_MAX];
    skg_status status = SKG_OK;
    *row = NULL;
    SKG_TRY_CLEANUP(skg_arrival_create(counter->sensor, kev, &arrival));
    SKG_TRY_CLEANUP(skg_alloc(1, sizeof **row, "counting detector", row));
    SKG_TRY_CLEANUP(skg_alloc(size, sizeof *(*row)->counts, "counting detector", &(*row)->counts));
    double *counts = (*row)->counts;
    for (int64_t h = 0; h < SKG_HISTORIES; h++)
        skg_pixels_count(&counter->counting, skg_arrival_follow(arrival, h, deposits), deposits, counts,
                         skg_counting_moves(&counter->counting) ? counts + tables : NULL);
    for (int64_t k = 0; k < size; k++) counts[k] *= skg_arrival_efficiency(arrival) / SKG_HISTORIES;
    for (int64_t t = windows; t < tables; t += SKG_COUNTING_PIXELS) mirror(counts + t);
    (*row)->kev = kev;
cleanup:
    skg_arrival_release(&arrival);
    if (status != SKG_OK) release_row(row);
    return status;
}

static const skg_counter_row *find_row(const skg_counter *counter, double kev) {
    for (int64_t r = 0; r < counter->row_count; r++)
        if (counter->rows[r]->kev == kev) return counter->rows[r];
    return NULL;
}

/* Rows that are missing: made by several threads, then taken over by the counter. */
typedef struct {
    skg_counter *counter;
    double *kev;
    skg_counter_row **made;
    int64_t count;
} missing;

static skg_status make_missing(void *user, int64_t item) {
    const missing *m = user;
    return make_row(m->counter, m->kev[item], &m->made[item]);
}

static skg_status add_rows(skg_counter *counter, int64_t count, const double *energy_kev) {
    missing m = {.counter = counter};
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *m.kev, "counting detector", &m.kev));
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof *m.made, "counting detector", &m.made));
    for (int64_t i = 0; i < count; i++)
        if (!find_row(counter, energy_kev[i]) && (m.count == 0 || m.kev[m.count - 1] != energy_kev[i]))
            m.kev[m.count++] = energy_kev[i];
    SKG_TRY_CLEANUP(skg_realloc(counter->row_count + m.count, sizeof(skg_counter_row *), "counting detector",
                                &counter->rows));
    SKG_TRY_CLEANUP(skg_parallel(m.count, make_missing, &m));
    for (int64_t i = 0; i < m.count; i++) counter->rows[counter->row_count++] = m.made[i], m.made[i] = NULL;
cleanup:
    for (int64_t i = 0; m.made && i < m.count; i++) release_row(&m.made[i]);
    skg_free(&m.kev);
    skg_free(&m.made);
    return status;
}

skg_status skg_counter_rows_get(skg_counter *counter, int64_t count, const double *energy_kev,
                                const skg_counter_row **rows) {
    for (int64_t i = 0; i < count; i++)
        if (!(energy_kev[i] >= SKG_LOWEST_KEV && energy_kev[i] <= SKG_PAIR_THRESHOLD_KEV))
            return skg_fail(
                SKG_ERR_BEAM,
                "counting detector: a photon of %g keV; what it counts is known from %g to %.0f keV",
                energy_kev[i], SKG_LOWEST_KEV, SKG_PAIR_THRESHOLD_KEV);
    pthread_mutex_lock(&counter->lock);
    const skg_status status = add_rows(counter, count, energy_kev);
    for (int64_t i = 0; i < count && status == SKG_OK; i++) rows[i] = find_row(counter, energy_kev[i]);
    pthread_mutex_unlock(&counter->lock);
    return status;
}

/* --- what callers get */

skg_status skg_counter_thresholds_get(const skg_counter *counter, int64_t *count) {
    SKG_NEEDS(counter);
    SKG_NEEDS(count);
    *count = counter->counting.count;
    return SKG_OK;
}

skg_status skg_counter_counts_get(skg_counter *counter, double energy_kev, double *counts) {
    SKG_PLAIN;
    const skg_counter_row *row = NULL;
    SKG_NEEDS(counter);
    SKG_NEEDS(counts);
    SKG_TRY(skg_counter_rows_get(counter, 1, &energy_kev, &row));
    memcpy(counts, row->counts, (size_t)counter->counting.count * sizeof *counts);
    return SKG_OK;
}

static skg_status check_window(const skg_counter *counter, int64_t window) {
    if (window >= 0 && window < counter->counting.count) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "counting detector: there is no window %" PRId64 "; 0 to %" PRId64,
                    window, counter->counting.count - 1);
}

skg_status skg_counter_spread_get(skg_counter *counter, double energy_kev, int64_t window, double *spread) {
    SKG_PLAIN;
    const skg_counter_row *row = NULL;
    SKG_NEEDS(counter);
    SKG_NEEDS(spread);
    SKG_TRY(check_window(counter, window));
    SKG_TRY(skg_counter_rows_get(counter, 1, &energy_kev, &row));
    memcpy(spread, skg_counter_spread(counter, row, window), SKG_COUNTING_PIXELS * sizeof *spread);
    return SKG_OK;
}

skg_status skg_counter_pairs_get(skg_counter *counter, double energy_kev, int64_t window, int64_t other,
                                 double *pairs) {
    SKG_PLAIN;
    const skg_counter_row *row = NULL;
    SKG_NEEDS(counter);
    SKG_NEEDS(pairs);
    SKG_TRY(check_window(counter, window));
    SKG_TRY(check_window(counter, other));
    SKG_TRY(skg_counter_rows_get(counter, 1, &energy_kev, &row));
    memcpy(pairs, skg_counter_pairs(counter, row, window, other), SKG_COUNTING_PIXELS * sizeof *pairs);
    return SKG_OK;
}
