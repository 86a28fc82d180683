/* The beam as a few lines, and what materials attenuate of each. */
#include "scatter/voxels.h"

#include "beam/spectrum.h"
#include "material/scattering.h"

#include <math.h>

/* From 1/cm. */
static const double PER_MM = 0.1;

void skg_beam_lines_find(const skg_spectrum *spectrum, skg_beam_lines *lines) {
    double all = 0, so_far = 0;
    *lines = (skg_beam_lines){0};
    for (int64_t e = 0; e < spectrum->count; e++) all += spectrum->photons[e] * spectrum->energy_kev[e];
    for (int64_t e = 0; e < spectrum->count; e++) {
        const double share = spectrum->photons[e] * spectrum->energy_kev[e] / all;
        if (!(share > 0)) continue;
        /* Shares may add to a little more than 1. */
        const int64_t line = (int64_t)fmin((so_far + 0.5 * share) * SKG_SCATTER_RANK, SKG_SCATTER_RANK - 1);
        lines->kev[line] += share * spectrum->energy_kev[e];
        lines->weight[line] += share;
        so_far += share;
    }
    for (int64_t line = 0; line < SKG_SCATTER_RANK; line++) {
        if (!(lines->weight[line] > 0)) continue;
        lines->kev[lines->count] = lines->kev[line] / lines->weight[line];
        lines->weight[lines->count++] = lines->weight[line];
    }
}

void skg_beam_lines_attenuated(const skg_beam_lines *lines, int64_t count, skg_material *const *materials,
                               double (*mu)[SKG_SCATTER_RANK]) {
    for (int64_t m = 0; m < count; m++)
        for (int64_t e = 0; e < SKG_SCATTER_RANK; e++) {
            double section[SKG_PROCESSES];
            mu[m][e] = 0;
            if (e >= lines->count) continue;
            skg_mixed_sections(materials[m]->count, materials[m]->parts, lines->kev[e], section);
            mu[m][e] = PER_MM * materials[m]->density * skg_total_section(section);
        }
}
