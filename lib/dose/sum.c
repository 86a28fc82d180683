/* The sum of exposures of one scene: a scan, a film. */
#include "dose/figures.h"

#include "core/text.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* --- places */

/* Backscatter is known of a sum if it is of every exposure that reaches the place: the factor of all the kerma together. */
static void sum_point(int64_t count, skg_dose *const *of, const double *times, int64_t p,
                      skg_dose_point *sum) {
    double all = 0, square = 0;
    *sum = (skg_dose_point){.size = sizeof *sum};
    memcpy(sum->at, of[0]->point[p].at, sizeof sum->at);
    for (int64_t i = 0; i < count; i++) {
        const skg_dose_point *one = &of[i]->point[p];
        const double kerma = times[i] * one->air_kerma_ugy;
        sum->in_field |= one->in_field;
        sum->air_kerma_ugy += kerma;
        if (!(kerma > 0)) continue;
        all += kerma * one->backscatter;
        square += pow(kerma * one->backscatter_sigma, 2);
    }
    const int known = sum->air_kerma_ugy > 0;
    sum->backscatter = known ? all / sum->air_kerma_ugy : (double)NAN;
    sum->backscatter_sigma = known ? sqrt(square) / sum->air_kerma_ugy : (double)NAN;
}

/* --- parts */

/* No photon came near a part in some exposures, perhaps: these add nothing to its error. */
static void sum_part(int64_t count, skg_dose *const *of, const double *times, int64_t p, skg_dose_part *sum) {
    double square = 0;
    int met = 0;
    *sum = (skg_dose_part){.size = sizeof *sum, .mass_g = of[0]->part[p].mass_g};
    for (int64_t i = 0; i < count; i++) {
        const skg_dose_part *one = &of[i]->part[p];
        sum->energy_kev += times[i] * one->energy_kev;
        sum->dose_ugy += times[i] * one->dose_ugy;
        if (isnan(one->sigma_ugy)) continue;
        square += pow(times[i] * one->sigma_ugy, 2);
        met = 1;
    }
    sum->sigma_ugy = met && !isnan(sum->dose_ugy) ? sqrt(square) : (double)NAN;
}

/* --- beam and detector */

static void sum_report(int64_t count, skg_dose *const *of, const double *times, skg_dose_report *sum) {
    double square = 0;
    sum->followed = 1, sum->scattered = of[0]->report.scattered;
    sum->hvl1_mm_al = of[0]->report.hvl1_mm_al, sum->hvl2_mm_al = of[0]->report.hvl2_mm_al;
    sum->exposure_index = count == 1 ? of[0]->report.exposure_index : (double)NAN;
    for (int64_t i = 0; i < count; i++) {
        const skg_dose_report *one = &of[i]->report;
        sum->followed &= one->followed;
        sum->kap_ugy_cm2 += times[i] * one->kap_ugy_cm2;
        sum->detector_air_kerma_ugy += times[i] * one->detector_air_kerma_ugy;
        sum->histories += one->histories;
        sum->incident_kev += times[i] * one->incident_kev, sum->escaped_kev += times[i] * one->escaped_kev;
        sum->world_kev += times[i] * one->world_kev;
        square += pow(times[i] * one->balance_sigma_kev, 2);
        sum->seconds += one->seconds;
    }
    sum->balance_sigma_kev = sqrt(square);
}

static skg_status check(int64_t count, skg_dose *const *of, const double *times) {
    if (count < 1 || !of)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_dose_sum: %" PRId64 " exposures; at least 1", count);
    for (int64_t i = 0; i < count; i++) {
        if (!of[i]) return skg_fail(SKG_ERR_ARGUMENT, "skg_dose_sum: exposure %" PRId64 " is NULL", i);
        if (times && !(times[i] >= 0 && isfinite(times[i])))
            return skg_fail(SKG_ERR_ARGUMENT, "skg_dose_sum: %g times exposure %" PRId64 "; at least 0",
                            times[i], i);
        if (of[i]->parts != of[0]->parts)
            return skg_fail(SKG_ERR_ARGUMENT,
                            "skg_dose_sum: exposure %" PRId64 " has %" PRId64 " parts, the first one %" PRId64
                            "; sum exposures of one scene",
                            i, of[i]->parts, of[0]->parts);
        for (int64_t p = 0; p < of[0]->points; p++)
            if (of[i]->points != of[0]->points ||
                memcmp(of[i]->point[p].at, of[0]->point[p].at, sizeof of[i]->point[p].at) != 0)
                return skg_fail(SKG_ERR_ARGUMENT,
                                "skg_dose_sum: exposure %" PRId64
                                " has other places than the first one; name them in skg_dose_options.points",
                                i);
    }
    return SKG_OK;
}

skg_status skg_dose_sum(int64_t count, skg_dose *const *exposures, const double *times, skg_dose **sum) {
    SKG_PLAIN;
    double *once = NULL;
    skg_dose *made = NULL;
    skg_status status = SKG_OK;
    SKG_NEEDS(sum);
    *sum = NULL;
    SKG_TRY(check(count, exposures, times));
    SKG_TRY(skg_alloc(count, sizeof *once, "dose", &once));
    for (int64_t i = 0; i < count; i++) once[i] = times ? times[i] : 1;
    SKG_TRY_CLEANUP(skg_dose_make(exposures[0]->points, exposures[0]->parts, &made));
    for (int64_t p = 0; p < made->points; p++) sum_point(count, exposures, once, p, &made->point[p]);
    for (int64_t p = 0; p < made->parts; p++) sum_part(count, exposures, once, p, &made->part[p]);
    sum_report(count, exposures, once, &made->report);
    *sum = made;
cleanup:
    skg_free(&once);
    return status;
}
