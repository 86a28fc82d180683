/* The energy that a detector records of a photon. */
#include "beam/response.h"
#include "beam/spectrum.h"
#include "core/files.h"
#include "core/text.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* A recorded energy may exceed that of the photon by this share, because published tables are rounded to three
 * digits. */
static const double ROUNDING = 0.01;

void skg_response_table_init_sized(void *table, int32_t size) {
    const skg_response_table defaults = {.meaning = SKG_RESPONSE_MEANING_SIGNAL};
    skg_struct_init(table, size, &defaults, sizeof defaults);
}

static skg_status check_noise(const skg_response_table *t, int64_t i) {
    if (t->efficiency && !(t->efficiency[i] >= 0 && t->efficiency[i] <= 1))
        return skg_fail(SKG_ERR_BEAM, "energy response, row %" PRId64 ": efficiency %g; give 0 to 1", i + 1,
                        t->efficiency[i]);
    if (t->efficiency && t->recorded_kev[i] > 0 && !(t->efficiency[i] > 0))
        return skg_fail(SKG_ERR_BEAM,
                        "energy response, row %" PRId64
                        ": %g keV recorded with efficiency 0; give more than 0",
                        i + 1, t->recorded_kev[i]);
    if (t->swank && !(t->swank[i] > 0 && t->swank[i] <= 1))
        return skg_fail(SKG_ERR_BEAM,
                        "energy response, row %" PRId64 ": Swank factor %g; give more than 0, up to 1", i + 1,
                        t->swank[i]);
    return SKG_OK;
}

static skg_status check_table(const skg_response_table *t) {
    if (t->count < 2 || !t->energies_kev || !t->recorded_kev)
        return skg_fail(SKG_ERR_BEAM, "an energy response has at least two energies");
    if (t->meaning != SKG_RESPONSE_MEANING_SIGNAL && t->meaning != SKG_RESPONSE_MEANING_ABSORBED)
        return skg_fail(SKG_ERR_BEAM,
                        "meaning %" PRId32
                        " of an energy response is unknown; SKG_RESPONSE_MEANING_SIGNAL or "
                        "SKG_RESPONSE_MEANING_ABSORBED",
                        t->meaning);
    if (t->meaning == SKG_RESPONSE_MEANING_ABSORBED && t->efficiency)
        return skg_fail(SKG_ERR_BEAM,
                        "an energy response of absorbed energies has its efficiency from these; leave the "
                        "efficiencies out, or give the meaning \"signal\"");
    for (int64_t i = 0; i < t->count; i++) {
        const double kev = t->energies_kev[i], recorded = t->recorded_kev[i];
        if (!(isfinite(kev) && kev >= 0) || (i > 0 && !(kev > t->energies_kev[i - 1])))
            return skg_fail(SKG_ERR_BEAM, "energy response, row %" PRId64 ": energies have to rise", i + 1);
        if (!(recorded >= 0 && recorded <= kev * (1 + ROUNDING)))
            return skg_fail(SKG_ERR_BEAM,
                            "energy response, row %" PRId64 ": %g keV recorded of a photon of %g keV; give 0 "
                            "to the energy of the photon",
                            i + 1, recorded, kev);
        SKG_TRY(check_noise(t, i));
    }
    return SKG_OK;
}

static skg_status copy(int64_t count, const double *from, double **to) {
    if (!from) return SKG_OK;
    SKG_TRY(skg_alloc(count, sizeof(double), "energy response", to));
    memcpy(*to, from, (size_t)count * sizeof(double));
    return SKG_OK;
}

skg_status skg_response_create_table(const skg_response_table *table, skg_response **response) {
    SKG_PLAIN;
    skg_response_table ours;
    skg_response *made = NULL;
    skg_status status = SKG_OK;
    SKG_NEEDS(response);
    *response = NULL;
    skg_response_table_init(&ours);
    SKG_TRY(skg_struct_read(table, "skg_response_table", &ours, sizeof ours));
    SKG_TRY(check_table(&ours));
    SKG_TRY(skg_alloc(1, sizeof *made, "energy response", &made));
    skg_refs_init(&made->refs);
    made->count = ours.count;
    made->meaning = ours.meaning;
    SKG_TRY_CLEANUP(copy(ours.count, ours.energies_kev, &made->energy_kev));
    SKG_TRY_CLEANUP(copy(ours.count, ours.recorded_kev, &made->recorded_kev));
    SKG_TRY_CLEANUP(copy(ours.count, ours.efficiency, &made->efficiency));
    SKG_TRY_CLEANUP(copy(ours.count, ours.swank, &made->swank));
    *response = made;
    return SKG_OK;
cleanup:
    skg_response_release(&made);
    return status;
}

skg_status skg_response_load(const char *path, const char *unit, int32_t meaning, skg_response **response) {
    SKG_PLAIN;
    SKG_NEEDS(path);
    SKG_NEEDS(unit);
    SKG_NEEDS(response);
    double kev = 1, *columns[4] = {NULL, NULL, NULL, NULL};
    int64_t count = 0, width = 0;
    skg_response_table table;
    *response = NULL;
    skg_response_table_init(&table);
    SKG_TRY(skg_unit_of_energy(unit, &kev));
    SKG_TRY(skg_read_columns_of(path, 2, 4, &count, &width, columns));
    for (int64_t i = 0; i < count; i++) columns[0][i] *= kev, columns[1][i] *= kev;
    table.meaning = meaning, table.count = count;
    table.energies_kev = columns[0], table.recorded_kev = columns[1];
    table.efficiency = columns[2], table.swank = columns[3];
    const skg_status status = skg_response_create_table(&table, response);
    for (int k = 0; k < 4; k++) skg_free(&columns[k]);
    if (status == SKG_ERR_BEAM) return skg_fail(status, "%s: %s", path, skg_last_error());
    return status;
}

skg_status skg_response_create_dqe(skg_response *response, int64_t count, const double *energies_kev,
                                   const double *dqe, skg_response **measured) {
    SKG_PLAIN;
    skg_response *made = NULL;
    skg_status status = SKG_OK;
    SKG_NEEDS(response);
    SKG_NEEDS(measured);
    *measured = NULL;
    if (count < 2 || !energies_kev || !dqe)
        return skg_fail(SKG_ERR_BEAM, "a table of the DQE has at least two energies");
    for (int64_t i = 0; i < count; i++) {
        if (!(isfinite(energies_kev[i]) && energies_kev[i] > (i ? energies_kev[i - 1] : 0)))
            return skg_fail(SKG_ERR_BEAM, "DQE, row %" PRId64 ": energies are above 0 and rise", i + 1);
        if (!(dqe[i] > 0 && dqe[i] <= 1))
            return skg_fail(SKG_ERR_BEAM, "DQE, row %" PRId64 ": %g; give more than 0, up to 1", i + 1,
                            dqe[i]);
    }
    SKG_TRY(skg_alloc(1, sizeof *made, "energy response", &made));
    skg_refs_init(&made->refs);
    made->count = count;
    made->base = response, skg_ref(&response->refs);
    SKG_TRY_CLEANUP(copy(count, energies_kev, &made->energy_kev));
    SKG_TRY_CLEANUP(copy(count, dqe, &made->efficiency));
    *measured = made;
    return SKG_OK;
cleanup:
    skg_response_release(&made);
    return status;
}

skg_status skg_response_retain(skg_response *response) {
    SKG_NEEDS(response);
    skg_ref(&response->refs);
    return SKG_OK;
}

void skg_response_release(skg_response **response) {
    if (!response || !*response) return;
    if (skg_unref(&(*response)->refs)) {
        skg_free(&(*response)->energy_kev);
        skg_free(&(*response)->recorded_kev);
        skg_free(&(*response)->efficiency);
        skg_free(&(*response)->swank);
        skg_deposition_release(&(*response)->deposition);
        skg_escape_release(&(*response)->escape);
        skg_response_release(&(*response)->base);
        skg_material_release(&(*response)->material);
        skg_free(response);
    }
    *response = NULL;
}

int skg_response_assumes_efficiency(const skg_response *response) {
    return response && response->count > 0 && response->meaning == SKG_RESPONSE_MEANING_SIGNAL &&
           !response->efficiency; /* a measured DQE says how noisy it is */
}

int skg_response_is_layer(const skg_response *response) {
    return response && (response->base ? skg_response_is_layer(response->base) : response->count == 0);
}

skg_status skg_response_depth_share(const skg_response *response, double energy_kev, double oblique,
                                    double from, double to, double *share) {
    double per_cm = 0;
    if (response->base) return skg_response_depth_share(response->base, energy_kev, oblique, from, to, share);
    SKG_TRY(skg_material_attenuation_get(response->material, energy_kev, &per_cm));
    const double depth = per_cm * response->mm / 10 * oblique;
    *share = exp(-depth * from) * expm1(-depth * (to - from)) / expm1(-depth);
    return SKG_OK;
}

int skg_response_escapes(const skg_response *response) {
    return response && (response->base ? skg_response_escapes(response->base) : response->escape != NULL);
}

int skg_response_transports(const skg_response *response) {
    return response &&
           (response->base ? skg_response_transports(response->base) : response->deposition != NULL);
}

/* Mean recorded energy in keV, efficiency and Swank factor for photons of one energy. */
typedef struct {
    double recorded, efficiency, swank;
} recording;

static double between(const double *values, int64_t low, double part) {
    return (1 - part) * values[low] + part * values[low + 1];
}

/* The row of a table below an energy, and how far it is to the next one, 0 to 1. */
static skg_status find_row(const skg_response *r, double energy_kev, int64_t *row, double *part) {
    int64_t low = 0, high = r->count - 1;
    if (!(energy_kev >= r->energy_kev[0] && energy_kev <= r->energy_kev[high]))
        return skg_fail(SKG_ERR_BEAM, "a photon energy of %g keV lies outside the detector %s %g to %g keV",
                        energy_kev, r->base ? "DQE's" : "response's", r->energy_kev[0], r->energy_kev[high]);
    while (high - low > 1) {
        int64_t middle = low + (high - low) / 2;
        if (r->energy_kev[middle] <= energy_kev)
            low = middle;
        else
            high = middle;
    }
    *row = low;
    *part = (energy_kev - r->energy_kev[low]) / (r->energy_kev[high] - r->energy_kev[low]);
    return SKG_OK;
}

static skg_status look_up(const skg_response *r, double energy_kev, recording *found) {
    int64_t low = 0;
    double part = 0;
    SKG_TRY(find_row(r, energy_kev, &low, &part));
    found->recorded = between(r->recorded_kev, low, part);
    if (r->meaning == SKG_RESPONSE_MEANING_ABSORBED)
        found->efficiency = fmin(found->recorded / energy_kev, 1);
    else if (r->efficiency)
        found->efficiency = between(r->efficiency, low, part);
    if (r->swank) found->swank = between(r->swank, low, part);
    return SKG_OK;
}

static skg_status record(const skg_response *response, double energy_kev, double oblique, recording *found);

/* The recording of the base, with the Swank factor of a measured DQE. */
static skg_status record_measured(const skg_response *r, double energy_kev, double oblique,
                                  recording *found) {
    recording straight;
    int64_t low = 0;
    double part = 0;
    SKG_TRY(record(r->base, energy_kev, 1, &straight));
    SKG_TRY(record(r->base, energy_kev, oblique, found));
    SKG_TRY(find_row(r, energy_kev, &low, &part));
    const double dqe = between(r->efficiency, low, part);
    /* Measured values and tables have some digits. */
    if (!(dqe <= straight.efficiency * (1 + ROUNDING)))
        return skg_fail(
            SKG_ERR_BEAM,
            "a DQE of %g at %g keV is more than the share of the photons that the detector records, "
            "%g; give a lower DQE, or a thicker layer",
            dqe, energy_kev, straight.efficiency);
    found->swank = fmin(dqe / straight.efficiency, 1);
    return SKG_OK;
}

static skg_status record(const skg_response *response, double energy_kev, double oblique, recording *found) {
    *found = (recording){energy_kev, 1, 1};
    if (!(energy_kev > 0))
        return skg_fail(SKG_ERR_BEAM, "a photon energy of %g keV is not usable", energy_kev);
    if (!(oblique >= 1))
        return skg_fail(SKG_ERR_ARGUMENT, "a path of %g thicknesses; give 1 or more", oblique);
    if (!response) return SKG_OK;
    if (response->base) return record_measured(response, energy_kev, oblique, found);
    if (response->count > 0) return look_up(response, energy_kev, found);
    double per_cm = 0;
    SKG_TRY(skg_material_attenuation_get(response->material, energy_kev, &per_cm));
    found->efficiency = -expm1(-per_cm * response->mm / 10 * oblique);
    found->recorded = energy_kev * found->efficiency;
    double left = 0, square = 0;
    if (response->deposition) {
        double mean = 0;
        skg_deposition_moments(response->deposition, energy_kev, per_cm / 10, oblique, &mean, &square);
        found->recorded = mean * found->efficiency;
        found->swank = square > 0 ? fmin(mean * mean / square, 1) : 1;
        return SKG_OK;
    }
    if (!response->escape) return SKG_OK;
    skg_escape_moments(response->escape, energy_kev, per_cm / 10, oblique, &left, &square);
    const double mean = energy_kev - left; /* of a photon that interacts */
    found->recorded = mean * found->efficiency;
    found->swank = mean * mean / (energy_kev * (energy_kev - 2 * left) + square);
    return SKG_OK;
}

double skg_response_lowest(const skg_response *response) {
    const double base = response->base ? skg_response_lowest(response->base) : 0;
    return response->count > 0 && response->energy_kev[0] > base ? response->energy_kev[0] : base;
}

skg_status skg_response_get(const skg_response *response, double energy_kev, double oblique,
                            double *recorded_kev, double *efficiency) {
    SKG_PLAIN;
    recording found;
    while (response && response->base) response = response->base; /* the DQE is of noise alone */
    SKG_TRY(record(response, energy_kev, oblique, &found));
    if (recorded_kev) *recorded_kev = found.recorded;
    if (efficiency) *efficiency = found.efficiency;
    return SKG_OK;
}

skg_status skg_response_swank_get(const skg_response *response, double energy_kev, double oblique,
                                  double *swank) {
    SKG_PLAIN;
    recording found;
    SKG_NEEDS(swank);
    SKG_TRY(record(response, energy_kev, oblique, &found));
    *swank = found.swank;
    return SKG_OK;
}
