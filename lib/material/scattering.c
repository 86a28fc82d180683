/* Form factors and scattering functions of atoms and materials. */
#include "material/scattering.h"

#include "materials/spline.h"

#include <math.h>

/* The last row at or below ln x, and not the very last. */
static int32_t find_row(double log_x) {
    int32_t low = 0, high = SKG_MOMENTA - 1;
    while (high - low > 1) {
        const int32_t middle = low + (high - low) / 2;
        if (skg_log_momenta[middle] <= log_x)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Rows are rounded to five digits, and a spline may exceed Z by as much. */
static double at_most(double limit, double value) {
    return value < limit ? value : limit;
}

void skg_atom_scattering(int32_t z, double x, double factors[SKG_SCATTERINGS]) {
    const skg_scattering_row *rows = skg_scattering_rows[z];
    const double first = exp(skg_log_momenta[0]), last = exp(skg_log_momenta[SKG_MOMENTA - 1]);
    double form, incoherent;
    if (x < first) {
        const double part = (x / first) * (x / first);
        form = z - part * (z - exp((double)rows[0].value[SKG_COHERENT]));
        incoherent = part * exp((double)rows[0].value[SKG_INCOHERENT]);
    } else if (x >= last) {
        const double ratio = last / x;
        form = exp((double)rows[SKG_MOMENTA - 1].value[SKG_COHERENT]) * ratio * ratio * ratio * ratio;
        incoherent = z;
    } else {
        const double t = log(x);
        const int32_t i = find_row(t);
        double value[SKG_SCATTERINGS];
        for (int k = 0; k < SKG_SCATTERINGS; k++) {
            const double y[2] = {(double)rows[i].value[k], (double)rows[i + 1].value[k]};
            const double d[2] = {(double)rows[i].second[k], (double)rows[i + 1].second[k]};
            value[k] = exp(skg_spline_value(t, skg_log_momenta[i], skg_log_momenta[i + 1], y, d));
        }
        form = at_most(z, value[SKG_COHERENT]);
        incoherent = at_most(z, value[SKG_INCOHERENT]);
    }
    factors[SKG_COHERENT] = form * form;
    factors[SKG_INCOHERENT] = incoherent;
}

skg_status skg_scattering_check(const skg_material *material) {
    if (material->kind == SKG_MATTER_COMPOSITION || skg_material_is_void(material)) return SKG_OK;
    return skg_fail(
        SKG_ERR_MATERIAL,
        "%s: a material given by its attenuation alone does not say how it scatters; give a formula "
        "(H2O), fractions by mass or a name of the tables, with its density",
        material->name);
}

skg_status skg_scattering_free(const skg_material *material, double x, double *coherent, double *incoherent) {
    double sums[SKG_SCATTERINGS] = {0};
    SKG_TRY(skg_scattering_check(material));
    for (int64_t i = 0; i < material->count; i++) {
        const skg_mass_fraction *part = &material->parts[i];
        const double atoms = SKG_AVOGADRO * part->fraction / skg_elements[part->z].weight;
        double own[SKG_SCATTERINGS];
        skg_atom_scattering(part->z, x, own);
        for (int k = 0; k < SKG_SCATTERINGS; k++) sums[k] += atoms * own[k];
    }
    *coherent = sums[SKG_COHERENT];
    *incoherent = sums[SKG_INCOHERENT];
    return SKG_OK;
}

/* The sum of F^2 over 1 g by the table of a material: linear between rows, the first of which also holds before it. Returns 0 where atoms are
 * free: without a table, and from its last row on. */
static int find_bound(const skg_material *material, double x, double *coherent) {
    const int64_t count = material->momentum_count;
    const double *momenta = material->momenta;
    if (count == 0 || !(x < momenta[count - 1])) return 0;
    int64_t low = 0, high = count - 1;
    while (high - low > 1) {
        const int64_t middle = (low + high) / 2;
        *(momenta[middle] <= x ? &low : &high) = middle;
    }
    const double share = fmax((x - momenta[low]) / (momenta[high] - momenta[low]), 0);
    *coherent = material->coherent[low] + share * (material->coherent[high] - material->coherent[low]);
    return 1;
}

skg_status skg_scattering_factors(const skg_material *material, double x, double *coherent,
                                  double *incoherent) {
    SKG_TRY(skg_scattering_free(material, x, coherent, incoherent));
    find_bound(material, x, coherent);
    return SKG_OK;
}
