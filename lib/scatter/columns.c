/* Attenuation by the energies of the tables. */
#include "scatter/voxels.h"

#include "material/scattering.h"

/* From 1/cm. */
static const double PER_MM = 0.1;

int64_t skg_scatter_first_row(const skg_scatter_physics *grid, int function) {
    return function <= SKG_SCATTER_INCOHERENT ? function * grid->energies
                                              : SKG_SCATTER_INCOHERENT * grid->energies +
                                                    (function - SKG_SCATTER_INCOHERENT) * grid->momenta;
}

static skg_status fill(const skg_material *material, const skg_scatter_physics *grid, double *column) {
    const double area = SKG_ELECTRON_RADIUS_CM * SKG_ELECTRON_RADIUS_CM;
    const double thickness = PER_MM * material->density;
    double *const total = column, *const compton = total + grid->energies;
    double *const rayleigh = compton + grid->energies, *const incoherent = rayleigh + grid->energies;
    double *const coherent = incoherent + grid->momenta;
    for (int64_t i = 0; i < grid->energies; i++) {
        double section[SKG_PROCESSES];
        skg_mixed_sections(material->count, material->parts, skg_scatter_energy(grid, i), section);
        total[i] = thickness * skg_total_section(section);
        compton[i] = thickness * section[SKG_COMPTON];
        rayleigh[i] = thickness * section[SKG_RAYLEIGH];
    }
    for (int64_t i = 0; i < grid->momenta; i++) {
        double square, function;
        SKG_TRY(skg_scattering_factors(material, skg_scatter_momentum(grid, i), &square, &function));
        incoherent[i] = thickness * area * function;
        coherent[i] = thickness * area * square;
    }
    return SKG_OK;
}

skg_status skg_scatter_columns(int64_t count, skg_material *const *materials, const skg_scatter_physics *grid,
                               double **columns) {
    const int64_t rows = skg_scatter_first_row(grid, SKG_SCATTER_FUNCTIONS);
    SKG_TRY(skg_alloc(count * rows, sizeof **columns, "scatter", columns));
    for (int64_t m = 0; m < count; m++) {
        const skg_status status = fill(materials[m], grid, *columns + m * rows);
        if (status == SKG_OK) continue;
        skg_free(columns);
        return status;
    }
    return SKG_OK;
}
