/* A response from pulse-height distributions. */
#include "beam/spectrum.h"
#include "core/text.h"

#include <inttypes.h>
#include <math.h>

/* A row may sum to more than 1 by this much, because printed probabilities are rounded. */
static const double ROUNDING = 1e-3;

typedef struct {
    double none, one, two; /* moments of order 0, 1 and 2 */
} moments;

static skg_status check_heights(int64_t heights, const double *height_kev) {
    if (heights < 1) return skg_fail(SKG_ERR_BEAM, "a pulse-height distribution has at least one height");
    for (int64_t h = 0; h < heights; h++)
        if (!(isfinite(height_kev[h]) && height_kev[h] > (h ? height_kev[h - 1] : 0)))
            return skg_fail(SKG_ERR_BEAM, "pulse height %" PRId64 ", %g keV: heights are above 0 and rise",
                            h + 1, height_kev[h]);
    return SKG_OK;
}

static skg_status take_moments(int64_t row, int64_t heights, const double *height_kev,
                               const double *probability, moments *m) {
    *m = (moments){0};
    for (int64_t h = 0; h < heights; h++) {
        const double p = probability[h];
        if (!(p >= 0 && p <= 1 + ROUNDING))
            return skg_fail(SKG_ERR_BEAM, "pulse heights, row %" PRId64 ": a probability of %g; give 0 to 1",
                            row + 1, p);
        m->none += p;
        m->one += p * height_kev[h];
        m->two += p * height_kev[h] * height_kev[h];
    }
    if (m->none > 1 + ROUNDING)
        return skg_fail(SKG_ERR_BEAM,
                        "pulse heights, row %" PRId64 ": probabilities sum to %g; give at most 1", row + 1,
                        m->none);
    return SKG_OK;
}

skg_status skg_response_create_pulses(int64_t count, const double *energies_kev, int64_t heights,
                                      const double *height_kev, const double *probability,
                                      skg_response **response) {
    SKG_PLAIN;
    double *made[3] = {NULL, NULL, NULL}; /* recorded energy, efficiency, Swank factor */
    skg_response_table table;
    skg_status status = SKG_OK;
    SKG_NEEDS(response);
    *response = NULL;
    SKG_NEEDS(height_kev);
    SKG_NEEDS(probability);
    SKG_TRY(check_heights(heights, height_kev));
    for (int k = 0; k < 3; k++)
        SKG_TRY_CLEANUP(skg_alloc(count > 0 ? count : 1, sizeof(double), "pulse heights", &made[k]));
    for (int64_t i = 0; i < count; i++) {
        moments m;
        SKG_TRY_CLEANUP(take_moments(i, heights, height_kev, probability + i * heights, &m));
        made[0][i] = m.one;
        made[1][i] = fmin(m.none, 1);
        made[2][i] = m.two > 0 ? fmin(m.one * m.one / (m.none * m.two), 1) : 1;
    }
    skg_response_table_init(&table);
    table.count = count;
    table.energies_kev = energies_kev;
    table.recorded_kev = made[0], table.efficiency = made[1], table.swank = made[2];
    status = skg_response_create_table(&table, response);
cleanup:
    for (int k = 0; k < 3; k++) skg_free(&made[k]);
    return status;
}
