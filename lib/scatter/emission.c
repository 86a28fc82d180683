/* Photons that the parts emit, fluorescence and annihilation: which shells do, and what a mm of a mixture emits at each energy. */
#include "scatter/interactions.h"

#include "core/maths.h"
#include "material/material.h"
#include "material/scattering.h"
#include "spectral/compression.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* From 1/cm. */
static const double PER_MM = 0.1;

/* A shell is left out if no interaction in any material emits so many of its photons. */
static const double NEGLIGIBLE = 1e-4;

/* Lines stand this far within the table of energies, so that they are followed when they have interacted. */
static const double ABOVE_LOWEST = 0.99;

/* --- shells */

static int holds(const skg_material *material, int32_t z, double *fraction) {
    for (int64_t i = 0; i < material->count; i++)
        if (material->parts[i].z == z) {
            *fraction = material->parts[i].fraction;
            return 1;
        }
    return 0;
}

/* The cross section of emission by an element, cm2/g: photo absorption times photons per absorption. An L shell has the vacancies that K alpha
 * leaves there, too. */
static double emitted(const skg_emitter *e, double kev) {
    double sections[SKG_PROCESSES];
    if (!(kev >= e->shell.edge_kev[0])) return 0;
    skg_element_sections(e->shell.row->z, kev, sections);
    const double alpha = e->has_deeper
                             ? e->deeper.row->yield * (e->deeper.row->share[0] + e->deeper.row->share[1]) *
                                   skg_shell_vacancies(&e->deeper, kev)
                             : 0;
    return sections[SKG_PHOTO] * (skg_shell_vacancies(&e->shell, kev) + alpha) * e->photons;
}

/* The cross section of emission by a material, cm2/g. */
static double emitted_by(const skg_emitter *e, const skg_material *material, double kev) {
    double fraction = 0, sections[SKG_PROCESSES];
    if (!e->pairs) return holds(material, e->shell.row->z, &fraction) ? fraction * emitted(e, kev) : 0;
    skg_mixed_sections(material->count, material->parts, kev, sections);
    return e->photons * sections[SKG_PAIR];
}

/* The lines above an energy: their shares add up to 1 in the last of them. */
static void find_lines(skg_emitter *e, double low_kev) {
    const skg_shell_row *row = e->shell.row;
    double sum = 0, sums[SKG_SCATTER_LINES] = {0};
    int last = -1;
    for (int l = 0; l < SKG_SCATTER_LINES; l++) {
        if (row->share[l] > 0 && row->line_kev[l] > low_kev) sum += row->share[l], last = l;
        sums[l] = sum;
    }
    for (int l = 0; l < SKG_SCATTER_LINES; l++) {
        const int at = l < last ? l : last;
        e->lines[l][0] = l >= last ? 1 : (float)(sums[l] / sum);
        e->lines[l][1] = at >= 0 ? (float)row->line_kev[at] : 0;
    }
    e->photons = row->yield * sum;
}

static int is_worth_it(const skg_emitter *e, int64_t count, skg_material *const *materials, double high_kev) {
    const double step = 1.02, edge = e->pairs ? SKG_PAIR_THRESHOLD_KEV : e->shell.edge_kev[0];
    for (int64_t m = 0; m < count; m++)
        for (double kev = edge; kev <= high_kev; kev *= step) {
            double sections[SKG_PROCESSES];
            const double own = emitted_by(e, materials[m], kev);
            if (!(own > 0)) continue;
            skg_mixed_sections(materials[m]->count, materials[m]->parts, kev, sections);
            if (own > NEGLIGIBLE * skg_total_section(sections)) return 1;
        }
    return 0;
}

/* One line, and two photons of it for each pair. */
static skg_emitter annihilation(void) {
    skg_emitter e = {.pairs = 1, .photons = 2};
    for (int l = 0; l < SKG_SCATTER_LINES; l++) e.lines[l][0] = 1, e.lines[l][1] = (float)SKG_ELECTRON_KEV;
    return e;
}

static int is_held(int64_t count, skg_material *const *materials, int32_t z) {
    double fraction = 0;
    for (int64_t m = 0; m < count; m++)
        if (holds(materials[m], z, &fraction)) return 1;
    return 0;
}

static void find_annihilation(int64_t count, skg_material *const *materials, double low_kev, double high_kev,
                              skg_emitters *emitters) {
    const skg_emitter e = annihilation();
    if (!(SKG_ELECTRON_KEV > low_kev) || !is_worth_it(&e, count, materials, high_kev)) return;
    emitters->of[emitters->count++] = e;
    emitters->lowest_kev = ABOVE_LOWEST * SKG_ELECTRON_KEV;
}

skg_status skg_emitters_find(int64_t count, skg_material *const *materials, int32_t fluorescence,
                             double low_kev, double high_kev, skg_emitters *emitters) {
    const int32_t lightest = fluorescence == SKG_FLUORESCENCE_ON ? 1 : SKG_FLUORESCENCE_LIGHTEST;
    *emitters = (skg_emitters){.lowest_kev = high_kev};
    SKG_TRY(skg_alloc((int64_t)SKG_SHELLS * SKG_LAST_ELEMENT + 1, sizeof *emitters->of, "emission",
                      &emitters->of));
    find_annihilation(count, materials, low_kev, high_kev, emitters);
    for (int32_t z = lightest; z <= SKG_LAST_ELEMENT && fluorescence != SKG_FLUORESCENCE_OFF; z++)
        for (int32_t kind = 0; kind < SKG_SHELLS && is_held(count, materials, z); kind++) {
            skg_emitter *e = &emitters->of[emitters->count];
            *e = (skg_emitter){.photons = 0};
            if (!skg_shell_find(z, kind, &e->shell) || !(e->shell.edge_kev[0] < high_kev)) continue;
            e->has_deeper = kind == SKG_SHELL_L && skg_shell_find(z, SKG_SHELL_K, &e->deeper);
            find_lines(e, low_kev);
            if (!is_worth_it(e, count, materials, high_kev)) continue;
            for (int l = 0; l < SKG_SCATTER_LINES; l++)
                if (e->shell.row->share[l] > 0 && e->shell.row->line_kev[l] > low_kev)
                    emitters->lowest_kev =
                        fmin(emitters->lowest_kev, ABOVE_LOWEST * e->shell.row->line_kev[l]);
            emitters->count++;
        }
    return SKG_OK;
}

void skg_emitters_free(skg_emitters *emitters) {
    skg_free(&emitters->of);
    emitters->count = 0;
}

/* --- tables */

skg_status skg_emission_make(int64_t count, skg_material *const *materials, const skg_emitters *emitters,
                             skg_scatter_physics *p) {
    static const int32_t all[SKG_SCATTER_RANK] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
    skg_least_squares system = {0};
    double most[2] = {0}, off[2] = {0}; /* of fluorescence, and of annihilation, which is much less */
    p->shells = emitters->count;
    p->emission_error = 0;
    if (p->shells == 0) return SKG_OK;
    skg_free(&p->emission);
    SKG_TRY(skg_alloc(p->energies * p->shells, sizeof *p->emission, "fluorescence", &p->emission));
    SKG_TRY(skg_least_squares_create(count, p->rank, &system));
    for (int64_t s = 0; s < p->shells; s++)
        for (int64_t i = 0; i < p->energies; i++) {
            const skg_emitter *e = &emitters->of[s];
            double x[SKG_SCATTER_RANK] = {0};
            for (int64_t m = 0; m < count; m++) {
                system.b[m] =
                    PER_MM * materials[m]->density * emitted_by(e, materials[m], skg_scatter_energy(p, i));
                for (int k = 0; k < p->rank; k++) system.a[k * count + m] = p->coefficients[m][k];
                most[e->pairs] = fmax(most[e->pairs], system.b[m]);
            }
            skg_least_squares_solve(&system, p->rank, all, x, NULL);
            for (int64_t m = 0; m < count; m++) {
                double fitted = 0;
                for (int k = 0; k < p->rank; k++) fitted += x[k] * p->coefficients[m][k];
                off[e->pairs] = fmax(off[e->pairs], fabs(fitted - system.b[m]));
            }
            for (int k = 0; k < p->rank; k++) p->emission[i * p->shells + s][k] = (float)x[k];
        }
    for (int k = 0; k < 2; k++)
        p->emission_error = fmax(p->emission_error, most[k] > 0 ? off[k] / most[k] : 0);
    skg_least_squares_release(&system);
    return SKG_OK;
}
