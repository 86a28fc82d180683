/* The energy that a detector records of a photon. */
#include "beam/spectrum.h"
#include "core/columns.h"
#include "core/plain.h"
#include "core/units.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

struct skg_response {
    skg_refs refs;
    int64_t count; /* rows of a table; 0: the response is a layer that absorbs */
    double *energy_kev, *recorded_kev, *efficiency;
    skg_material *material; /* retained */
    double mm;              /* thickness at the full density of the material */
};

/* A recorded energy may exceed that of the photon by this share, because published tables are rounded to three
 * digits. */
static const double ROUNDING = 0.01;

static skg_status check_table(int64_t count, const double *energies, const double *recorded,
                              const double *efficiency) {
    if (count < 2 || !energies || !recorded)
        return skg_fail(SKG_ERR_BEAM, "an energy response has at least two energies");
    for (int64_t i = 0; i < count; i++) {
        if (!(isfinite(energies[i]) && energies[i] >= 0) || (i > 0 && !(energies[i] > energies[i - 1])))
            return skg_fail(SKG_ERR_BEAM, "energy response, row %" PRId64 ": energies have to rise", i + 1);
        if (!(recorded[i] >= 0 && recorded[i] <= energies[i] * (1 + ROUNDING)))
            return skg_fail(SKG_ERR_BEAM,
                            "energy response, row %" PRId64 ": %g keV recorded of a photon of %g keV; give 0 "
                            "to the energy of the photon",
                            i + 1, recorded[i], energies[i]);
        if (efficiency && !(efficiency[i] >= 0 && efficiency[i] <= 1))
            return skg_fail(SKG_ERR_BEAM, "energy response, row %" PRId64 ": efficiency %g; give 0 to 1",
                            i + 1, efficiency[i]);
    }
    return SKG_OK;
}

static skg_status copy(int64_t count, const double *from, double **to) {
    SKG_TRY(skg_alloc(count, sizeof(double), "energy response", to));
    memcpy(*to, from, (size_t)count * sizeof(double));
    return SKG_OK;
}

skg_status skg_response_create_table(int64_t count, const double *energies_kev, const double *recorded_kev,
                                     const double *efficiency, skg_response **response) {
    SKG_PLAIN;
    SKG_NEEDS(response);
    *response = NULL;
    SKG_TRY(check_table(count, energies_kev, recorded_kev, efficiency));
    skg_response *made = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(skg_alloc(1, sizeof *made, "energy response", &made));
    skg_refs_init(&made->refs);
    made->count = count;
    SKG_TRY_CLEANUP(copy(count, energies_kev, &made->energy_kev));
    SKG_TRY_CLEANUP(copy(count, recorded_kev, &made->recorded_kev));
    if (efficiency) SKG_TRY_CLEANUP(copy(count, efficiency, &made->efficiency));
    *response = made;
    return SKG_OK;
cleanup:
    skg_response_release(&made);
    return status;
}

skg_status skg_response_load(const char *path, const char *unit, skg_response **response) {
    SKG_PLAIN;
    SKG_NEEDS(path);
    SKG_NEEDS(unit);
    SKG_NEEDS(response);
    double kev = 1, *energies = NULL, *recorded = NULL;
    int64_t count = 0;
    *response = NULL;
    SKG_TRY(skg_unit_of_energy(unit, &kev));
    SKG_TRY(skg_read_columns(path, NULL, &count, &energies, &recorded));
    for (int64_t i = 0; i < count; i++) energies[i] *= kev, recorded[i] *= kev;
    skg_status status = skg_response_create_table(count, energies, recorded, NULL, response);
    skg_free(&energies);
    skg_free(&recorded);
    if (status == SKG_ERR_BEAM) return skg_fail(status, "%s: %s", path, skg_last_error());
    return status;
}

static skg_status make_layer(const skg_material *material, double mm, skg_response **response) {
    skg_response *made = NULL;
    skg_material *own = NULL;
    double unused = 0, density = 0;
    SKG_TRY(skg_material_density_get(material, &density));
    SKG_TRY(skg_material_attenuation_get(material, 60, &unused)); /* fails unless the density is known */
    /* The caller's material is const and cannot be retained, so the layer gets its own. */
    SKG_TRY(skg_material_create_at_density(material, density, &own));
    skg_status status = skg_alloc(1, sizeof *made, "energy response", &made);
    if (status != SKG_OK) {
        skg_material_release(&own);
        return status;
    }
    skg_refs_init(&made->refs);
    made->material = own;
    made->mm = mm;
    *response = made;
    return SKG_OK;
}

skg_status skg_response_create_scintillator(const skg_material *material, double thickness_mm, double packing,
                                            skg_response **response) {
    SKG_PLAIN;
    SKG_NEEDS(response);
    *response = NULL;
    if (!(isfinite(thickness_mm) && thickness_mm > 0))
        return skg_fail(SKG_ERR_BEAM, "a scintillator of %g mm is not usable; give a thickness above 0",
                        thickness_mm);
    if (!(packing > 0 && packing <= 1))
        return skg_fail(SKG_ERR_BEAM, "a scintillator's packing of %g is not usable; give above 0, up to 1",
                        packing);
    return make_layer(material, thickness_mm * packing, response);
}

skg_status skg_response_create_screen(const skg_material *material, double mg_cm2, skg_response **response) {
    SKG_PLAIN;
    SKG_NEEDS(response);
    *response = NULL;
    double density = 0;
    if (!(isfinite(mg_cm2) && mg_cm2 > 0))
        return skg_fail(SKG_ERR_BEAM, "a screen of %g mg/cm2 is not usable; give a mass above 0", mg_cm2);
    SKG_TRY(skg_material_density_get(material, &density));
    if (!(density > 0)) return make_layer(material, 1, response); /* fails with the sentence on the density */
    return make_layer(material, mg_cm2 / 1000 / density * 10, response);
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
        skg_material_release(&(*response)->material);
        skg_free(response);
    }
    *response = NULL;
}

static skg_status look_up(const skg_response *r, double energy_kev, double *recorded, double *efficiency) {
    int64_t low = 0, high = r->count - 1;
    if (!(energy_kev >= r->energy_kev[0] && energy_kev <= r->energy_kev[high]))
        return skg_fail(SKG_ERR_BEAM,
                        "a photon energy of %g keV lies outside the detector response's %g to %g keV",
                        energy_kev, r->energy_kev[0], r->energy_kev[high]);
    while (high - low > 1) {
        int64_t middle = low + (high - low) / 2;
        if (r->energy_kev[middle] <= energy_kev)
            low = middle;
        else
            high = middle;
    }
    double part = (energy_kev - r->energy_kev[low]) / (r->energy_kev[high] - r->energy_kev[low]);
    *recorded = (1 - part) * r->recorded_kev[low] + part * r->recorded_kev[high];
    *efficiency = r->efficiency ? (1 - part) * r->efficiency[low] + part * r->efficiency[high]
                                : fmin(*recorded / energy_kev, 1);
    return SKG_OK;
}

skg_status skg_response_get(const skg_response *response, double energy_kev, double oblique,
                            double *recorded_kev, double *efficiency) {
    SKG_PLAIN;
    double recorded = energy_kev, seen = 1;
    if (!(energy_kev > 0))
        return skg_fail(SKG_ERR_BEAM, "a photon energy of %g keV is not usable", energy_kev);
    if (!(oblique >= 1))
        return skg_fail(SKG_ERR_ARGUMENT, "a path of %g thicknesses; give 1 or more", oblique);
    if (response && response->count > 0) {
        SKG_TRY(look_up(response, energy_kev, &recorded, &seen));
    } else if (response) {
        double per_cm = 0;
        SKG_TRY(skg_material_attenuation_get(response->material, energy_kev, &per_cm));
        seen = -expm1(-per_cm * response->mm / 10 * oblique);
        recorded = energy_kev * seen;
    }
    if (recorded_kev) *recorded_kev = recorded;
    if (efficiency) *efficiency = seen;
    return SKG_OK;
}
